// SPDX-License-Identifier: MIT
#include "sink/vdb/module/grid_builder.hpp"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "field/visit_type.hpp"

// A dense volume becomes a tree layer by layer, eight planes to a layer of leaves, so that no more
// than one layer is ever held unpruned.

namespace mc::sink {

namespace {

using openvdb::Coord;
using openvdb::Index;

constexpr std::int32_t kLeafSize = 8;

/// Least and greatest finite sample.
struct Extremes {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void add(const Extremes& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
};

/// A value that is not solid at any iso within the data, and which the convention of the class
/// allows: level sets want a positive one.
double outside_value(const Volume& volume, const Extremes& extremes) {
  if (!below_is_solid(volume.cls)) return std::min(0.0, extremes.low);
  const Affine& map = volume.lattice.to_world;
  const double cell = std::max({map.spacing(0), map.spacing(1), map.spacing(2)});
  return std::max(cell, extremes.high);
}

/// The outside value in the grid's type, and in half where samples are saved so.
template <class Value>
Value stored_outside(double value, bool as_half) {
  if constexpr (std::is_same_v<Value, bool>) {
    return false;
  } else if constexpr (std::is_integral_v<Value>) {
    constexpr Value kMost = std::numeric_limits<Value>::max();
    return value < static_cast<double>(kMost) ? static_cast<Value>(std::ceil(value)) : kMost;
  } else {
    if (!as_half) return static_cast<Value>(value);
    const auto most = static_cast<double>(to_float(Half{0x7BFF}));
    return to_float(to_half(static_cast<float>(std::min(value, most))));
  }
}

/// Samples of type T into a grid of type Grid.
template <class T, class Grid>
class TypedBuilder final : public GridBuilder {
 public:
  explicit TypedBuilder(const Volume& volume)
      : volume_(volume),
        dims_(volume.lattice.dims()),
        blocks_x_((dims_[0] + kLeafSize - 1) / kLeafSize),
        blocks_y_((dims_[1] + kLeafSize - 1) / kLeafSize) {}

  void add(const Slab& slab) override;
  void add(const LeafReader& reader) override;
  openvdb::GridBase::Ptr finish() override;

 private:
  using Tree = typename Grid::TreeType;
  using Leaf = typename Tree::LeafNodeType;
  using Value = typename Grid::ValueType;
  using LeafPtr = std::unique_ptr<Leaf>;

  static Value converted(T sample) { return static_cast<Value>(field::number(sample)); }
  static void put(Leaf& leaf, std::size_t at, T sample);
  static bool uniform(const Leaf& leaf);

  void begin_layer(std::int32_t k);
  template <bool Swap>
  void fill_rows(const Slab& slab, std::size_t first, std::size_t last);
  template <bool Swap>
  Extremes fill_leaf(Leaf& leaf, const Slab& slab, std::size_t first, std::size_t last) const;
  void end_layer();
  void add_tile(const Tile& tile);
  static LeafPtr copied_leaf(const LeafReader& reader, std::size_t n);

  Volume volume_;
  // Wide samples stay wide unless they come as they were stored.
  bool as_half_ = std::is_same_v<T, Half>;
  Index3 dims_;
  std::int32_t blocks_x_;
  std::int32_t blocks_y_;
  typename Grid::Ptr grid_ = Grid::create();
  std::vector<LeafPtr> layer_;  // the leaves being filled, x fastest
  std::int32_t next_k_ = 0;
  Extremes extremes_;
  bool dense_ = false;
};

template <class T, class Grid>
void TypedBuilder<T, Grid>::put(Leaf& leaf, std::size_t at, T sample) {
  if constexpr (std::is_same_v<Value, bool>) {
    leaf.setValueOnly(static_cast<Index>(at), converted(sample));
  } else {
    leaf.buffer().data()[at] = converted(sample);
  }
}

/// Whether all values are equal in every bit (-0 is not 0, and a NaN equals itself).
template <class T, class Grid>
bool TypedBuilder<T, Grid>::uniform(const Leaf& leaf) {
  if constexpr (std::is_same_v<Value, bool>) {
    return leaf.buffer() == typename Leaf::Buffer(leaf.getFirstValue());
  } else {
    const auto bytes = std::as_bytes(std::span(leaf.buffer().data(), std::size_t{Leaf::SIZE}));
    const std::size_t step = sizeof(Value);
    return std::memcmp(bytes.data(), bytes.data() + step, bytes.size() - step) == 0;
  }
}

template <class T, class Grid>
void TypedBuilder<T, Grid>::begin_layer(std::int32_t k) {
  const auto n_x = static_cast<std::size_t>(blocks_x_);
  layer_.resize(n_x * static_cast<std::size_t>(blocks_y_));
  base::for_ranges(layer_.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const Coord origin(static_cast<std::int32_t>(n % n_x) * kLeafSize,
                         static_cast<std::int32_t>(n / n_x) * kLeafSize, k);
      layer_[n] = std::make_unique<Leaf>(origin, Value(0), false);
    }
  });
}

/// Planes [first, last) of the slab, all of them of one layer, into one leaf.
template <class T, class Grid>
template <bool Swap>
Extremes TypedBuilder<T, Grid>::fill_leaf(Leaf& leaf, const Slab& slab, std::size_t first,
                                          std::size_t last) const {
  Extremes extremes;
  const Coord origin = leaf.origin();
  const std::int32_t n_x = std::min(kLeafSize, dims_[0] - origin.x());
  const std::int32_t n_y = std::min(kLeafSize, dims_[1] - origin.y());
  const std::size_t z0 = static_cast<std::size_t>(slab.k0 - origin.z()) + first;
  for (std::int32_t y = 0; y < n_y; ++y) {
    const std::size_t row = static_cast<std::size_t>(origin.y() + y) * slab.row_stride_bytes;
    for (std::int32_t x = 0; x < n_x; ++x) {
      const std::size_t at = row + static_cast<std::size_t>(origin.x() + x) * sizeof(T);
      const auto column = static_cast<std::size_t>(x * 64 + y * 8) + z0;
      for (std::size_t n = first; n < last; ++n) {
        const T sample = field::load_sample<T, Swap>(slab.planes[n] + at);
        put(leaf, column + (n - first), sample);
        leaf.setValueOn(static_cast<Index>(column + (n - first)));
        extremes.add(static_cast<double>(field::number(sample)));
      }
    }
  }
  return extremes;
}

template <class T, class Grid>
template <bool Swap>
void TypedBuilder<T, Grid>::fill_rows(const Slab& slab, std::size_t first, std::size_t last) {
  std::mutex mutex;
  base::for_ranges(layer_.size(), 16, [&](std::size_t begin, std::size_t end) {
    Extremes extremes;
    for (std::size_t n = begin; n < end; ++n) {
      extremes.add(fill_leaf<Swap>(*layer_[n], slab, first, last));
    }
    const std::lock_guard lock(mutex);
    extremes_.add(extremes);
  });
}

/// Hands the layer to the tree, uniform leaves as tiles.
template <class T, class Grid>
void TypedBuilder<T, Grid>::end_layer() {
  std::vector<char> is_tile(layer_.size());
  base::for_ranges(layer_.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      is_tile[n] = static_cast<char>(layer_[n]->isDense() && uniform(*layer_[n]));
    }
  });
  typename Grid::Accessor access = grid_->getAccessor();
  for (std::size_t n = 0; n < layer_.size(); ++n) {
    if (is_tile[n] != 0) {
      access.addTile(1, layer_[n]->origin(), layer_[n]->getFirstValue(), true);
    } else {
      access.addLeaf(layer_[n].release());
    }
  }
  layer_.clear();
}

template <class T, class Grid>
void TypedBuilder<T, Grid>::add(const Slab& slab) {
  assert(slab.k0 == next_k_);
  dense_ = true;
  for (std::size_t first = 0; first < slab.planes.size();) {
    if (next_k_ % kLeafSize == 0) begin_layer(next_k_);
    const auto n_left = slab.planes.size() - first;
    const auto n_layer = static_cast<std::size_t>(kLeafSize - next_k_ % kLeafSize);
    const std::size_t last = first + std::min(n_left, n_layer);
    if (volume_.endian == std::endian::native) {
      fill_rows<false>(slab, first, last);
    } else {
      fill_rows<true>(slab, first, last);
    }
    next_k_ += static_cast<std::int32_t>(last - first);
    first = last;
    if (next_k_ % kLeafSize == 0 || next_k_ == dims_[2]) end_layer();
  }
}

template <class T, class Grid>
void TypedBuilder<T, Grid>::add_tile(const Tile& tile) {
  const Coord origin(tile.origin[0], tile.origin[1], tile.origin[2]);
  const Value value = converted(tile.value.as<T>());
  for (const auto& [size, level] : {std::pair{8, 1}, std::pair{128, 2}, std::pair{4096, 3}}) {
    if (tile.size == size) {
      grid_->tree().addTile(static_cast<Index>(level), origin, value, tile.active);
      return;
    }
  }
  grid_->tree().sparseFill(
      openvdb::CoordBBox::createCube(origin, static_cast<Coord::ValueType>(tile.size)), value,
      tile.active);
}

template <class T, class Grid>
typename TypedBuilder<T, Grid>::LeafPtr TypedBuilder<T, Grid>::copied_leaf(const LeafReader& reader,
                                                                           std::size_t n) {
  const Index3& origin = reader.leaves()[n];
  alignas(64) std::array<std::byte, LeafReader::kLeafSamples * sizeof(std::uint64_t)> scratch;
  const std::byte* values = reader.leaf_values(n, scratch.data());
  auto leaf = std::make_unique<Leaf>(Coord(origin[0], origin[1], origin[2]), Value(0), false);
  for (std::size_t at = 0; at < LeafReader::kLeafSamples; ++at) {
    put(*leaf, at, field::load_sample<T, false>(values + at * sizeof(T)));
  }
  // OpenVDB's mask has the same bits in the same order.
  const std::array<std::uint64_t, 8> active = reader.leaf_active(n);
  for (std::size_t word = 0; word < active.size(); ++word) {
    leaf->getValueMask().template getWord<std::uint64_t>(static_cast<Index>(word)) = active[word];
  }
  return leaf;
}

template <class T, class Grid>
void TypedBuilder<T, Grid>::add(const LeafReader& reader) {
  grid_ = Grid::create(converted(reader.background().template as<T>()));
  as_half_ |= std::is_floating_point_v<T> && volume_.stored_as == "half";
  for (const Tile& tile : reader.tiles()) add_tile(tile);
  std::vector<LeafPtr> leaves(reader.leaves().size());
  base::for_ranges(leaves.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) leaves[n] = copied_leaf(reader, n);
  });
  typename Grid::Accessor access = grid_->getAccessor();
  for (LeafPtr& leaf : leaves) access.addLeaf(leaf.release());
}

template <class T, class Grid>
openvdb::GridBase::Ptr TypedBuilder<T, Grid>::finish() {
  if (dense_) {
    if (next_k_ != dims_[2]) {
      throw Error(ErrorKind::internal, volume_.name, "the volume was not written to its end");
    }
    const auto outside = stored_outside<Value>(outside_value(volume_, extremes_), as_half_);
    grid_->tree().root().setBackground(outside, /*updateChildNodes=*/true);
    openvdb::tools::prune(grid_->tree());
  }
  grid_->setSaveFloatAsHalf(as_half_);
  return grid_;
}

}  // namespace

bool below_is_solid(VolumeClass cls) {
  return cls == VolumeClass::level_set || cls == VolumeClass::sdf_spec;
}

std::unique_ptr<GridBuilder> grid_builder_for(const Volume& volume) {
  return field::visit_type(
      volume.type, [&]<class T>(field::TypeTag<T>) -> std::unique_ptr<GridBuilder> {
        if constexpr (std::is_same_v<T, std::uint8_t>) {
          if (volume.cls == VolumeClass::mask) {
            return std::make_unique<TypedBuilder<T, openvdb::BoolGrid>>(volume);
          }
        }
        if constexpr (std::is_same_v<T, Half> || std::is_same_v<T, float>) {
          return std::make_unique<TypedBuilder<T, openvdb::FloatGrid>>(volume);
        } else if constexpr (std::is_same_v<T, double>) {
          return std::make_unique<TypedBuilder<T, openvdb::DoubleGrid>>(volume);
        } else if constexpr (std::is_same_v<T, std::uint32_t> || std::is_same_v<T, std::int64_t>) {
          return std::make_unique<TypedBuilder<T, openvdb::Int64Grid>>(volume);
        } else {
          return std::make_unique<TypedBuilder<T, openvdb::Int32Grid>>(volume);
        }
      });
}

}  // namespace mc::sink
