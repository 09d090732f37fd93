// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <tuple>
#include <vector>

#include "field/block.hpp"
#include "field/visit_type.hpp"
#include "mc/field.hpp"

// Views of volumes as other volumes: a box of a sparse one as planes, and a part of a dense one.
// Both keep a reference to what they look at, and both put the box's corner into the affine, so
// that every sample stays where it was.

namespace mc {

using field::kBlockSize;

namespace {

/// What a view of `box` says of itself.
Volume viewed(const Volume& whole, const IndexBox& box) {
  Volume out = whole;
  const Vec3 corner =
      whole.lattice.to_world({static_cast<double>(box.lo[0]), static_cast<double>(box.lo[1]),
                              static_cast<double>(box.lo[2])});
  for (std::size_t a = 0; a < 3; ++a) {
    out.lattice.to_world.m[4 * a + 3] = corner[a];
    out.lattice.box.lo[a] = 0;
    out.lattice.box.hi[a] = static_cast<std::int32_t>(box.extent(static_cast<int>(a)) - 1);
  }
  out.n_active.reset();
  return out;
}

/// The part of [origin, origin + size) that lies in [lo, hi], as offsets from lo: [first, last).
struct Overlap {
  std::int64_t first;
  std::int64_t last;

  Overlap(std::int64_t origin, std::int64_t size, std::int64_t lo, std::int64_t hi)
      : first(std::max(origin, lo) - lo), last(std::min(origin + size, hi + 1) - lo) {}
  [[nodiscard]] bool empty() const { return first >= last; }
  [[nodiscard]] std::size_t length() const { return static_cast<std::size_t>(last - first); }
};

/// A cube's part of the planes being filled.
struct Overlap3 {
  Overlap x, y, z;

  Overlap3(const Index3& origin, std::int32_t size, const IndexBox& box)
      : x(origin[0], size, box.lo[0], box.hi[0]),
        y(origin[1], size, box.lo[1], box.hi[1]),
        z(origin[2], size, box.lo[2], box.hi[2]) {}
  [[nodiscard]] bool empty() const { return x.empty() || y.empty() || z.empty(); }
};

/// Planes under construction: contiguous samples of `box`.
template <class T>
struct Planes {
  IndexBox box;
  T* samples;

  [[nodiscard]] T* row(std::int64_t j, std::int64_t k) const {
    return samples + (k * box.extent(1) + j) * box.extent(0);
  }
};

template <class T>
void fill_cube(const Planes<T>& out, const Tile& tile) {
  const Overlap3 part(tile.origin, tile.size, out.box);
  if (part.empty()) return;
  const T value = tile.value.as<T>();
  for (std::int64_t k = part.z.first; k < part.z.last; ++k) {
    for (std::int64_t j = part.y.first; j < part.y.last; ++j) {
      std::fill_n(out.row(j, k) + part.x.first, part.x.length(), value);
    }
  }
}

template <class T>
void fill_leaf(const Planes<T>& out, const Index3& origin, const std::byte* values) {
  const Overlap3 part(origin, kBlockSize, out.box);
  const std::int64_t x0 = out.box.lo[0] + part.x.first - origin[0];
  const std::int64_t y0 = out.box.lo[1] + part.y.first - origin[1];
  const std::int64_t z0 = out.box.lo[2] + part.z.first - origin[2];
  for (std::int64_t k = part.z.first; k < part.z.last; ++k) {
    for (std::int64_t j = part.y.first; j < part.y.last; ++j) {
      const std::int64_t column = (y0 + j - part.y.first) * 8 + (z0 + k - part.z.first);
      const std::byte* from = values + (x0 * 64 + column) * std::ptrdiff_t{sizeof(T)};
      T* to = out.row(j, k) + part.x.first;
      for (std::size_t i = 0; i < part.x.length(); ++i) {
        std::memcpy(to + i, from + i * 64 * sizeof(T), sizeof(T));
      }
    }
  }
}

class DenseView final : public SlabReader {
 public:
  DenseView(const LeafReader& sparse, const IndexBox& box);

  [[nodiscard]] const Volume& volume() const override { return volume_; }
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override;
  // Filling moves each sample once, from memory that the sparse volume holds anyway.
  [[nodiscard]] bool rereads_cheaply() const override { return true; }

 private:
  struct TilesOfSize {
    std::int32_t size;
    std::size_t begin;
    std::size_t end;
  };

  template <class T>
  void fill(const IndexBox& planes, std::byte* samples) const;
  template <class F>
  void for_tiles(const IndexBox& planes, F&& f) const;
  template <class F>
  void for_leaves(const IndexBox& planes, F&& f) const;

  const LeafReader& sparse_;
  IndexBox box_;
  Volume volume_;
  std::vector<Tile> tiles_;  // those that meet the box, by (size, z)
  std::vector<TilesOfSize> sizes_;
};

DenseView::DenseView(const LeafReader& sparse, const IndexBox& box)
    : sparse_(sparse), box_(box), volume_(viewed(sparse.volume(), box)) {
  assert(box.extent(0) > 0 && box.extent(1) > 0 && box.extent(2) > 0);
  for (const Tile& tile : sparse.tiles()) {
    if (!Overlap3(tile.origin, tile.size, box).empty()) tiles_.push_back(tile);
  }
  std::sort(tiles_.begin(), tiles_.end(), [](const Tile& a, const Tile& b) {
    return std::tie(a.size, a.origin[2], a.origin[1], a.origin[0]) <
           std::tie(b.size, b.origin[2], b.origin[1], b.origin[0]);
  });
  for (std::size_t n = 0; n < tiles_.size(); ++n) {
    if (n == 0 || tiles_[n].size != sizes_.back().size) sizes_.push_back({tiles_[n].size, n, n});
    sizes_.back().end = n + 1;
  }
}

template <class F>
void DenseView::for_tiles(const IndexBox& planes, F&& f) const {
  for (const TilesOfSize& group : sizes_) {
    const auto first = tiles_.begin() + static_cast<std::ptrdiff_t>(group.begin);
    const auto last = tiles_.begin() + static_cast<std::ptrdiff_t>(group.end);
    const std::int64_t below = std::int64_t{planes.lo[2]} - group.size;
    auto at = std::partition_point(first, last,
                                   [&](const Tile& tile) { return tile.origin[2] <= below; });
    for (; at != last && at->origin[2] <= planes.hi[2]; ++at) f(*at);
  }
}

/// Leaves are ordered by (z, y, x): one search finds the layer of blocks, another the row in it.
template <class F>
void DenseView::for_leaves(const IndexBox& planes, F&& f) const {
  const std::span<const Index3> leaves = sparse_.leaves();
  const auto before = [](std::size_t axis, std::int64_t bound) {
    return [axis, bound](const Index3& leaf) { return leaf[axis] < bound; };
  };
  const auto first_z = std::int64_t{planes.lo[2]} - (kBlockSize - 1);
  auto layer = std::partition_point(leaves.begin(), leaves.end(), before(2, first_z));
  while (layer != leaves.end() && (*layer)[2] <= planes.hi[2]) {
    const auto next = std::partition_point(layer, leaves.end(), before(2, (*layer)[2] + 1LL));
    const auto first_y = std::int64_t{planes.lo[1]} - (kBlockSize - 1);
    auto at = std::partition_point(layer, next, before(1, first_y));
    for (; at != next && (*at)[1] <= planes.hi[1]; ++at) {
      if (!Overlap3(*at, kBlockSize, planes).empty()) {
        f(static_cast<std::size_t>(at - leaves.begin()));
      }
    }
    layer = next;
  }
}

template <class T>
void DenseView::fill(const IndexBox& planes, std::byte* samples) const {
  const Planes<T> out{planes, reinterpret_cast<T*>(samples)};
  const std::int64_t n_samples = planes.extent(0) * planes.extent(1) * planes.extent(2);
  std::fill_n(out.samples, static_cast<std::size_t>(n_samples), sparse_.background().as<T>());
  for_tiles(planes, [&](const Tile& tile) { fill_cube(out, tile); });
  alignas(64) std::array<std::byte, LeafReader::kLeafSamples * sizeof(std::uint64_t)> scratch;
  for_leaves(planes, [&](std::size_t n) {
    fill_leaf(out, sparse_.leaves()[n], sparse_.leaf_values(n, scratch.data()));
  });
}

void DenseView::read(std::int32_t k0, std::int32_t k1, Slab& out) const {
  assert(0 <= k0 && k0 <= k1 && k1 <= volume_.lattice.dims()[2]);
  out.allocate(planes_of(volume_.lattice.box, k0, k1), sample_size(volume_.type));
  if (k0 == k1) return;
  const IndexBox planes = planes_of(box_, k0, k1);
  field::visit_type(volume_.type, [&]<class T>(field::TypeTag<T>) {
    fill<typename field::Bits<sizeof(T)>::type>(planes, out.storage.data());
  });
}

class CropView final : public SlabReader {
 public:
  CropView(const SlabReader& whole, const IndexBox& box)
      : whole_(whole), box_(box), volume_(viewed(whole.volume(), box)) {
    assert(whole.volume().lattice.box.contains(box));
    assert(box.extent(0) > 0 && box.extent(1) > 0 && box.extent(2) > 0);
  }

  [[nodiscard]] const Volume& volume() const override { return volume_; }
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override {
    if (whole_.reads_boxes_cheaply()) {
      out.allocate(planes_of(volume_.lattice.box, k0, k1), sample_size(volume_.type));
      if (k0 != k1) whole_.read_box(planes_of(box_, k0, k1), out.storage);
      return;
    }
    whole_.read(k0 + box_.lo[2], k1 + box_.lo[2], out);
    out.k0 = k0;
    const std::size_t skip = static_cast<std::size_t>(box_.lo[1]) * out.row_stride_bytes +
                             static_cast<std::size_t>(box_.lo[0]) * sample_size(volume_.type);
    for (const std::byte*& plane : out.planes) plane += skip;
  }
  [[nodiscard]] bool rereads_cheaply() const override { return whole_.rereads_cheaply(); }
  [[nodiscard]] std::uint64_t held_bytes() const override { return whole_.held_bytes(); }

 private:
  const SlabReader& whole_;
  IndexBox box_;
  Volume volume_;
};

}  // namespace

std::unique_ptr<SlabReader> dense_view(const LeafReader& sparse, const IndexBox& box) {
  return std::make_unique<DenseView>(sparse, box);
}

std::unique_ptr<SlabReader> crop_view(const SlabReader& whole, const IndexBox& box) {
  return std::make_unique<CropView>(whole, box);
}

}  // namespace mc
