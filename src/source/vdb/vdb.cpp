// SPDX-License-Identifier: MIT
#include "source/vdb/vdb.hpp"

#include "source/magic.hpp"
#include "source/vdb/layout.hpp"

// Trees are read without OpenVDB: within bounds, so that a file cut off anywhere is an error at
// once; without its library, which takes longer to load than most files; and on all cores.

namespace mc::source {

Recognition recognise_vdb(std::string_view head) { return recognised(looks_like_vdb(head)); }

}  // namespace mc::source

#if MC_WITH_VDB

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>

#include "field/volume_names.hpp"
#include "source/placement.hpp"
#include "source/source_input.hpp"
#include "source/text.hpp"
#include "source/vdb/choice.hpp"
#include "source/vdb/placing.hpp"
#include "source/vdb/tree_outline.hpp"
#include "source/vdb/tree_reader.hpp"

namespace mc::source {

namespace {

std::string naming(const VdbGrid& grid) {
  return fmt::format("grid {}", quoted_text(grid.shown_name()));
}

/// Runs `f`; what it asks for and does not get leaves as an Error about `what`.
template <class F>
auto with_memory_for(std::string_view what, std::string_view place, F&& f) {
  const auto too_large = [&] {
    return Error(ErrorKind::limit, place, fmt::format("not enough memory for {}", what));
  };
  try {
    return f();
  } catch (const std::bad_alloc&) {
    throw too_large();
  } catch (const std::length_error&) {
    throw too_large();
  }
}

/// A file with the outline of all its grids. Where they have no offsets their trees are walked too,
/// for what follows a grid can then only be found behind it.
class VdbFile {
 public:
  explicit VdbFile(MappedFile file)
      : file_(std::make_shared<const MappedFile>(std::move(file))),
        bytes_(file_->bytes()),
        place_(file_->place()),
        layout_(read_vdb_layout(bytes_, place_)) {
    std::size_t at = layout_.first_descriptor;
    for (std::uint32_t n = 0; n < layout_.n_grids; ++n) {
      grids_.push_back(read_vdb_grid(bytes_, layout_, at, place_));
      const bool is_last = n + 1 == layout_.n_grids;
      at = layout_.has_offsets || is_last ? grids_.back().end : end_of(grids_.back());
    }
    number_grids(grids_);
  }

  [[nodiscard]] std::span<const VdbGrid> grids() const { return grids_; }
  [[nodiscard]] const std::string& place() const { return place_; }

  /// Everything but what the tree says. The map stays as it is where it is not linear.
  [[nodiscard]] std::pair<Volume, std::string> outline(const VdbGrid& grid) const {
    Volume volume;
    volume.name = grid.shown_name();
    volume.format = kVdbFormat.name;
    volume.type = scalar_type(grid).value_or(SampleType::f32);
    volume.cls = volume_class(grid);
    volume.units = grid.meta_text("mc_units") == "mm" ? Units::mm : Units::m;
    const std::string frame = grid.meta_text("mc_frame");
    volume.frame = frame == "lps" ? Frame::lps : frame == "ras" ? Frame::ras : Frame::none;
    volume.iso = grid.meta_double("mc_iso");
    volume.border = field::border_named(grid.meta_text("mc_border"));
    volume.stored_as = grid.as_half ? "half" : "";
    VdbCursor cursor = cursor_at_body(grid);
    const std::optional<Affine> map = read_vdb_map(cursor, naming(grid));
    volume.lattice.to_world = map.value_or(Affine{});
    std::string refused = refusal(grid);
    if (refused.empty() && !map) {
      refused = "frustum transform, but only linear transforms can be meshed";
    }
    return {volume, refused};
  }

  /// Reads the tree of a grid that can be meshed.
  [[nodiscard]] std::unique_ptr<LeafReader> load(std::size_t chosen, const Volume& volume,
                                                 LeafValues wanted,
                                                 std::uint64_t memory_bytes) const {
    const VdbGrid& grid = owner_of_tree(grids_[chosen]);
    const std::string name = naming(grids_[chosen]);
    return with_memory_for(name, place_, [&] {
      VdbCursor cursor = cursor_at_body(grid);
      read_vdb_map(cursor, name);
      const TreeFile file{file_, tree_kind(grid).value(), name};
      return read_vdb_tree(file, walk_vdb_tree(cursor, file.kind, name), volume, wanted,
                           memory_bytes);
    });
  }

 private:
  [[nodiscard]] VdbCursor cursor_at_body(const VdbGrid& grid) const {
    return {grid.end == 0 ? bytes_ : bytes_.first(grid.end), grid.body, place_};
  }

  /// Where a grid without offsets ends.
  [[nodiscard]] std::size_t end_of(const VdbGrid& grid) const {
    const std::string name = naming(grid);
    return with_memory_for(name, place_, [&] {
      VdbCursor cursor = cursor_at_body(grid);
      read_vdb_map(cursor, name);
      if (grid.instance_of.empty()) {
        const std::optional<TreeKind> kind = tree_kind(grid);
        if (!kind) {
          throw Error(ErrorKind::input, place_,
                      fmt::format("{}: type {} in a file without offsets: what follows it cannot "
                                  "be found",
                                  name, quoted_text(grid.type_name())),
                      "write the file again, to a disk and not to a pipe");
        }
        walk_vdb_tree(cursor, *kind, name);
      }
      return cursor.at();
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

  std::shared_ptr<const MappedFile> file_;
  std::span<const std::byte> bytes_;
  std::string place_;
  VdbLayout layout_;
  std::vector<VdbGrid> grids_;
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

Source open_vdb(SourceInput& input, const SourceOptions& options, Progress& /*progress*/) {
  const VdbFile file(map_file(input));
  const std::size_t chosen = choose_grid(file.grids(), options.grid, file.place());
  auto [volume, refused] = file.outline(file.grids()[chosen]);
  const std::string name = naming(file.grids()[chosen]);
  if (!refused.empty()) {
    throw Error(ErrorKind::input, file.place(), fmt::format("{}: {}", name, refused),
                "resample it to a linear transform first");
  }
  check_map(volume.lattice.to_world, fmt::format("{}: {}", file.place(), name));
  volume.lattice.to_world = placed(volume.lattice.to_world, options);
  std::unique_ptr<LeafReader> reader =
      file.load(chosen, volume, LeafValues::read, options.memory_bytes);
  if (is_empty(*reader)) {
    throw Error(ErrorKind::input, file.place(),
                fmt::format("{}: empty, it holds nothing but background", name));
  }
  Source out;
  out.reader = std::move(reader);
  for (std::size_t n = 0; n < file.grids().size(); ++n) {
    if (n != chosen && scalar_type(file.grids()[n])) {
      out.other_grids.push_back(file.grids()[n].shown_name());
    }
  }
  return out;
}

std::vector<GridDescription> describe_vdb(SourceInput& input, Progress& /*progress*/) {
  const VdbFile file(map_file(input));
  std::vector<GridDescription> out;
  for (std::size_t n = 0; n < file.grids().size(); ++n) {
    const VdbGrid& grid = file.grids()[n];
    auto [volume, refused] = file.outline(grid);
    if (!take_statistics(grid, volume) && refused.empty()) {
      const std::unique_ptr<LeafReader> reader = file.load(n, volume, LeafValues::left_packed, 0);
      volume = reader->volume();
      refused = is_empty(*reader) ? "empty" : "";
    }
    out.push_back({volume, grid.type_name(), refused});
  }
  return out;
}

}  // namespace mc::source

#endif
