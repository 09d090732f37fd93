// SPDX-License-Identifier: MIT
#include "source/vdb/vdb.hpp"

// The one file that reads with OpenVDB. It hands over transforms and trees only; what precedes them
// was walked within bounds (layout.hpp). The stream has no bytes but the grid's own and throws at
// their end, so a file cut off anywhere is an error and not a wait. OpenVDB's io::File is not used:
// it accepts half of some damaged headers, and copies files.

#if MC_WITH_VDB

#include <fmt/format.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <istream>
#include <limits>
#include <new>
#include <tuple>
#include <utility>

#include "field/volume_names.hpp"
#include "source/placement.hpp"
#include "source/text.hpp"
#include "source/vdb/byte_streambuf.hpp"
#include "source/vdb/choice.hpp"
#include "source/vdb/layout.hpp"

namespace mc::source {

namespace {

/// Runs `f`; whatever OpenVDB throws leaves as an Error about `what`.
template <class F>
auto through_door(std::string_view place, const std::string& what, F&& f) {
  const auto damaged = [&] {
    return Error(ErrorKind::input, place, fmt::format("{} is damaged or cut off", what),
                 "fetch or write the file again");
  };
  const auto too_large = [&] {
    return Error(ErrorKind::limit, place, fmt::format("not enough memory for {}", what));
  };
  try {
    return f();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw too_large();
  } catch (const std::length_error&) {
    throw too_large();
  } catch (const std::exception&) {
    throw damaged();
  }
}

void initialize_once() {
  static const bool done = [] {
    openvdb::initialize();
    return true;
  }();
  static_cast<void>(done);
}

/// Where a grid begins in its file, as an OpenVDB stream set up for it.
class GridStream {
 public:
  GridStream(std::span<const std::byte> file, const VdbLayout& layout, const VdbGrid& grid)
      : buffer_(grid.end == 0 ? file : file.first(grid.end)), stream_(&buffer_) {
    stream_.exceptions(std::ios_base::failbit | std::ios_base::badbit | std::ios_base::eofbit);
    meta_->setSeekable(true);
    meta_->setFileVersion(layout.file_version);
    meta_->setLibraryVersion({layout.library_major, layout.library_minor});
    meta_->setCompression(grid.compression);
    meta_->setGridClass(
        static_cast<std::uint32_t>(openvdb::GridBase::stringToGridClass(grid.meta_text("class"))));
    meta_->setHalfFloat(grid.as_half);
    meta_->setBackgroundPtr(nullptr);
    openvdb::io::setStreamMetadataPtr(stream_, meta_, /*transfer=*/true);
    stream_.seekg(static_cast<std::streamoff>(grid.body));
  }
  [[nodiscard]] std::istream& stream() { return stream_; }
  [[nodiscard]] std::size_t at() { return static_cast<std::size_t>(stream_.tellg()); }

 private:
  ByteStreambuf buffer_;
  std::istream stream_;
  openvdb::io::StreamMetadata::Ptr meta_ = std::make_shared<openvdb::io::StreamMetadata>();
};

/// OpenVDB multiplies rows by matrices, we matrices by columns: the transpose.
/// Returns nullopt for a map that is not linear.
std::optional<Affine> affine_of(const openvdb::math::Transform& transform) {
  if (!transform.isLinear()) {
    return std::nullopt;
  }
  const openvdb::Mat4d matrix = transform.baseMap()->getAffineMap()->getMat4();
  Affine out;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      out.m[static_cast<std::size_t>(4 * row + column)] = matrix(column, row);
    }
  }
  return out;
}

std::string naming(const VdbGrid& grid) {
  return fmt::format("grid {}", quoted_text(grid.shown_name()));
}

/// Reads the transform at the stream's position.
openvdb::math::Transform::Ptr read_transform(std::istream& stream) {
  auto transform = std::make_shared<openvdb::math::Transform>();
  transform->read(stream);
  return transform;
}

/// Reads the grid's tree; the stream stands behind its transform.
openvdb::GridBase::Ptr read_tree(std::istream& stream, const VdbGrid& grid,
                                 std::string_view place) {
  const std::streampos at = stream.tellg();
  std::int32_t n_buffers = 0;
  stream.read(reinterpret_cast<char*>(&n_buffers), sizeof n_buffers);
  stream.seekg(at);
  if (n_buffers != 1) {  // OpenVDB would print a warning and read on
    throw Error(
        ErrorKind::input, place,
        fmt::format("{}: a tree of {} buffers, but one was expected", naming(grid), n_buffers));
  }
  if (!openvdb::GridBase::isRegistered(grid.tree_type)) {
    throw Error(ErrorKind::input, place, fmt::format("{}: {}", naming(grid), refusal(grid)));
  }
  openvdb::GridBase::Ptr tree = openvdb::GridBase::createGrid(grid.tree_type);
  tree->setSaveFloatAsHalf(grid.as_half);
  tree->readTopology(stream);
  tree->readBuffers(stream);
  return tree;
}

/// Samples of a leaf as the port wants them: OpenVDB's own memory, or bits spread to bytes.
template <class LeafT>
const std::byte* values_of(const LeafT& leaf, std::byte* scratch) {
  if constexpr (std::is_same_v<typename LeafT::ValueType, bool>) {
    for (openvdb::Index n = 0; n < LeafReader::kLeafSamples; ++n) {
      scratch[n] = std::byte{leaf.getValue(n)};
    }
    return scratch;
  } else {
    return reinterpret_cast<const std::byte*>(leaf.buffer().data());
  }
}

template <class T>
Scalar scalar_of(T value) {
  if constexpr (std::is_same_v<T, bool>) {
    return Scalar::of(static_cast<std::uint8_t>(value));
  } else {
    return Scalar::of(value);
  }
}

Index3 index_of(const openvdb::Coord& at) { return {at.x(), at.y(), at.z()}; }

/// Appends the tiles of a node and of those below it.
template <class NodeT>
void collect_tiles(const NodeT& node, const Scalar& background, std::vector<Tile>& tiles) {
  using Child = typename NodeT::ChildNodeType;
  for (auto tile = node.cbeginValueAll(); tile; ++tile) {
    const Scalar value = scalar_of(tile.getValue());
    if (tile.isValueOn() || !(value == background)) {
      tiles.push_back({index_of(tile.getCoord()), static_cast<std::int32_t>(Child::DIM), value,
                       tile.isValueOn()});
    }
  }
  if constexpr (Child::LEVEL > 0) {
    for (auto child = node.cbeginChildOn(); child; ++child) {
      collect_tiles(*child, background, tiles);
    }
  }
}

void grow(IndexBox& box, const Index3& lo, std::int32_t size) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::min(box.lo[axis], lo[axis]);
    box.hi[axis] = std::max(box.hi[axis], lo[axis] + size - 1);
  }
}

/// Root keys are stored as they are in the file, and nodes below them rounded: only rounded keys
/// keep nodes apart. The limit leaves the engine room to look at neighbours in 32 bits.
void check_key(const Index3& key, std::string_view place) {
  constexpr std::int32_t kRoot = 4096;
  constexpr std::int32_t kFarthest = 1 << 30;
  for (const std::int32_t n : key) {
    if (n % kRoot != 0) {
      throw Error(ErrorKind::input, place, "damaged VDB file: a node that no node fits beside");
    }
    if (n < -kFarthest || n > kFarthest - kRoot) {
      throw Error(ErrorKind::limit, place,
                  "samples lie further than 2^30 from index 0, beyond what can be meshed");
    }
  }
}

template <class GridT>
class TreeReader final : public LeafReader {
  using TreeT = typename GridT::TreeType;
  using LeafT = typename TreeT::LeafNodeType;

 public:
  TreeReader(typename GridT::ConstPtr grid, Volume volume, std::string_view place)
      : grid_(std::move(grid)), volume_(std::move(volume)) {
    const TreeT& tree = grid_->constTree();
    background_ = scalar_of(tree.background());
    for (auto child = tree.root().cbeginChildAll(); child; ++child) {
      check_key(index_of(child.getCoord()), place);
    }
    collect_tiles(tree.root(), background_, tiles_);
    collect_leaves(tree);
    volume_.n_active = tree.activeVoxelCount();
    volume_.lattice.box = extent(tree);
  }

  [[nodiscard]] const Volume& volume() const override { return volume_; }
  [[nodiscard]] Scalar background() const override { return background_; }
  [[nodiscard]] std::span<const Index3> leaves() const override { return origins_; }
  const std::byte* leaf_values(std::size_t n, std::byte* scratch) const override {
    return values_of(*leaves_[n], scratch);
  }
  [[nodiscard]] std::array<std::uint64_t, 8> leaf_active(std::size_t n) const override {
    std::array<std::uint64_t, 8> words{};
    for (openvdb::Index w = 0; w < 8; ++w) {
      words[w] = leaves_[n]->valueMask().template getWord<openvdb::Index64>(w);
    }
    return words;
  }
  [[nodiscard]] std::span<const Tile> tiles() const override { return tiles_; }

 private:
  void collect_leaves(const TreeT& tree) {
    tree.getNodes(leaves_);
    std::ranges::sort(leaves_, [](const LeafT* a, const LeafT* b) {
      const openvdb::Coord p = a->origin();
      const openvdb::Coord q = b->origin();
      return std::tuple(p.z(), p.y(), p.x()) < std::tuple(q.z(), q.y(), q.x());
    });
    origins_.reserve(leaves_.size());
    for (const LeafT* leaf : leaves_) {
      origins_.push_back(index_of(leaf->origin()));
    }
  }

  /// Active samples; where none is active, all that is stored (inactive values count as values).
  IndexBox extent(const TreeT& tree) const {
    openvdb::CoordBBox active;
    if (tree.evalActiveVoxelBoundingBox(active)) {
      return {index_of(active.min()), index_of(active.max())};
    }
    if (origins_.empty() && tiles_.empty()) {
      return {};
    }
    constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
    IndexBox box{{kMost, kMost, kMost}, {-kMost, -kMost, -kMost}};
    for (const Index3& origin : origins_) {
      grow(box, origin, static_cast<std::int32_t>(LeafT::DIM));
    }
    for (const Tile& tile : tiles_) {
      grow(box, tile.origin, tile.size);
    }
    return box;
  }

  typename GridT::ConstPtr grid_;
  Volume volume_;
  Scalar background_;
  std::vector<const LeafT*> leaves_;
  std::vector<Index3> origins_;
  std::vector<Tile> tiles_;
};

/// Wraps the tree in the reader of its type. Precondition: the type is one of the six.
std::unique_ptr<LeafReader> reader_of(const openvdb::GridBase::Ptr& tree, const Volume& volume,
                                      std::string_view place) {
  std::unique_ptr<LeafReader> reader;
  const auto try_type = [&]<class GridT>(std::type_identity<GridT>) {
    if (auto grid = openvdb::gridConstPtrCast<GridT>(tree)) {
      reader = std::make_unique<TreeReader<GridT>>(grid, volume, place);
    }
    return reader != nullptr;
  };
  const bool known = try_type(std::type_identity<openvdb::FloatGrid>{}) ||
                     try_type(std::type_identity<openvdb::DoubleGrid>{}) ||
                     try_type(std::type_identity<openvdb::Int32Grid>{}) ||
                     try_type(std::type_identity<openvdb::Int64Grid>{}) ||
                     try_type(std::type_identity<openvdb::BoolGrid>{}) ||
                     try_type(std::type_identity<openvdb::MaskGrid>{});
  if (!known) {
    throw Error(ErrorKind::internal, place, "a grid type without a reader");
  }
  return reader;
}

/// A file with the outline of all its grids; where they have no offsets also their trees, for these
/// can only be found by reading what precedes them.
class VdbFile {
 public:
  explicit VdbFile(const MappedFile& file)
      : bytes_(file.bytes()), place_(file.place()), layout_(read_vdb_layout(bytes_, place_)) {
    initialize_once();
    std::size_t at = layout_.first_descriptor;
    for (std::uint32_t n = 0; n < layout_.n_grids; ++n) {
      grids_.push_back(read_vdb_grid(bytes_, layout_, at, place_));
      at = layout_.has_offsets ? grids_.back().end : read_in_order(grids_.back());
    }
    number_grids(grids_);
  }

  [[nodiscard]] std::span<const VdbGrid> grids() const { return grids_; }
  [[nodiscard]] const std::string& place() const { return place_; }

  /// Everything but what the tree says. The map stays as it is where it is not linear.
  [[nodiscard]] std::pair<Volume, std::string> outline(const VdbGrid& grid) const {
    Volume volume;
    volume.name = grid.shown_name();
    volume.format = "vdb";
    volume.type = scalar_type(grid).value_or(SampleType::f32);
    volume.cls = volume_class(grid);
    volume.units = grid.meta_text("mc_units") == "mm" ? Units::mm : Units::m;
    const std::string frame = grid.meta_text("mc_frame");
    volume.frame = frame == "lps" ? Frame::lps : frame == "ras" ? Frame::ras : Frame::none;
    volume.iso = grid.meta_double("mc_iso");
    volume.border = field::border_named(grid.meta_text("mc_border"));
    volume.stored_as = grid.as_half ? "half" : "";
    const std::optional<Affine> map = through_door(place_, naming(grid), [&] {
      GridStream stream(bytes_, layout_, grid);
      return affine_of(*read_transform(stream.stream()));
    });
    volume.lattice.to_world = map.value_or(Affine{});
    std::string refused = refusal(grid);
    if (refused.empty() && !map) {
      refused = "frustum transform, but only linear transforms can be meshed";
    }
    return {volume, refused};
  }

  /// Reads the tree of a grid that can be meshed.
  [[nodiscard]] std::unique_ptr<LeafReader> load(std::size_t chosen, const Volume& volume) const {
    const VdbGrid& grid = grids_[chosen];
    return through_door(place_, naming(grid), [&] {
      return reader_of(layout_.has_offsets ? read_at_offset(owner_of_tree(grid)) : trees_[chosen],
                       volume, place_);
    });
  }

 private:
  [[nodiscard]] openvdb::GridBase::Ptr read_at_offset(const VdbGrid& grid) const {
    GridStream stream(bytes_, layout_, grid);
    read_transform(stream.stream());
    return read_tree(stream.stream(), grid, place_);
  }

  /// Reads a grid where it stands and returns where the next descriptor is.
  std::size_t read_in_order(const VdbGrid& grid) {
    return through_door(place_, naming(grid), [&] {
      GridStream stream(bytes_, layout_, grid);
      read_transform(stream.stream());
      trees_.push_back(grid.instance_of.empty()
                           ? read_tree(stream.stream(), grid, place_)
                           : trees_[static_cast<std::size_t>(&owner_of_tree(grid) - &grids_[0])]);
      return stream.at();
    });
  }

  /// The grid itself, or the one whose tree it shares.
  [[nodiscard]] const VdbGrid& owner_of_tree(const VdbGrid& grid) const {
    if (grid.instance_of.empty()) {
      return grid;
    }
    const auto owner = std::ranges::find_if(grids_, [&](const VdbGrid& g) {
      return g.unique_name == grid.instance_of && g.instance_of.empty() &&
             g.tree_type == grid.tree_type;
    });
    if (owner == grids_.end()) {
      throw Error(ErrorKind::input, place_,
                  fmt::format("{} shares the tree of a grid that is not there", naming(grid)));
    }
    return *owner;
  }

  std::span<const std::byte> bytes_;
  std::string place_;
  VdbLayout layout_;
  std::vector<VdbGrid> grids_;
  std::vector<openvdb::GridBase::Ptr> trees_;  // of files without offsets, one for each grid
};

bool is_empty(const LeafReader& reader) {
  return reader.leaves().empty() && reader.tiles().empty();
}

/// Fills in what the writer noted of the tree. False: nothing, or nothing that can be believed.
bool take_statistics(const VdbGrid& grid, Volume& volume) {
  const auto lo = grid.meta_vec3i("file_bbox_min");
  const auto hi = grid.meta_vec3i("file_bbox_max");
  const auto n_active = grid.meta_int64("file_voxel_count");
  if (!lo || !hi || !n_active || *n_active <= 0) {
    return false;
  }
  const IndexBox box{*lo, *hi};
  for (int axis = 0; axis < 3; ++axis) {
    if (box.extent(axis) < 1 || box.extent(axis) > std::numeric_limits<std::int32_t>::max()) {
      return false;
    }
  }
  volume.lattice.box = box;
  volume.n_active = static_cast<std::uint64_t>(*n_active);
  return true;
}

}  // namespace

VdbSource open_vdb(const MappedFile& mapped, const SourceOptions& options) {
  const VdbFile file(mapped);
  const std::size_t chosen = choose_grid(file.grids(), options.grid, file.place());
  auto [volume, refused] = file.outline(file.grids()[chosen]);
  const std::string name = naming(file.grids()[chosen]);
  if (!refused.empty()) {
    throw Error(ErrorKind::input, file.place(), fmt::format("{}: {}", name, refused),
                "resample it to a linear transform first");
  }
  check_map(volume.lattice.to_world, fmt::format("{}: {}", file.place(), name));
  volume.lattice.to_world = placed(volume.lattice.to_world, options);
  VdbSource out;
  out.reader = file.load(chosen, volume);
  if (is_empty(*out.reader)) {
    throw Error(ErrorKind::input, file.place(),
                fmt::format("{}: empty, it holds nothing but background", name));
  }
  for (std::size_t n = 0; n < file.grids().size(); ++n) {
    if (n != chosen && scalar_type(file.grids()[n])) {
      out.other_grids.push_back(file.grids()[n].shown_name());
    }
  }
  return out;
}

std::vector<GridDescription> describe_vdb(const MappedFile& mapped) {
  const VdbFile file(mapped);
  std::vector<GridDescription> out;
  for (std::size_t n = 0; n < file.grids().size(); ++n) {
    const VdbGrid& grid = file.grids()[n];
    auto [volume, refused] = file.outline(grid);
    if (!take_statistics(grid, volume) && refused.empty()) {
      const std::unique_ptr<LeafReader> reader = file.load(n, volume);
      volume = reader->volume();
      refused = is_empty(*reader) ? "empty" : "";
    }
    out.push_back({volume, grid.type_name(), refused});
  }
  return out;
}

}  // namespace mc::source

#endif
