// SPDX-License-Identifier: MIT
#include "support/memory_readers.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

// Volumes in memory behind the two ports. Everything is copied and nothing is clever: these are
// what the clever code is compared with.

namespace mc::test {

namespace {

IndexBox box_of(const Index3& origin, const Index3& dims) {
  return {origin, {origin[0] + dims[0] - 1, origin[1] + dims[1] - 1, origin[2] + dims[2] - 1}};
}

std::size_t index_in(const IndexBox& box, const Index3& p) {
  const std::int64_t row =
      (std::int64_t{p[2]} - box.lo[2]) * box.extent(1) + (std::int64_t{p[1]} - box.lo[1]);
  return static_cast<std::size_t>(row * box.extent(0) + (std::int64_t{p[0]} - box.lo[0]));
}

/// Calls f(n, p) for the 512 samples of the block at `origin` in leaf order.
template <class F>
void for_block(const Index3& origin, F&& f) {
  for (std::size_t n = 0; n < LeafReader::kLeafSamples; ++n) {
    const auto at = static_cast<std::int32_t>(n);
    f(n, Index3{origin[0] + at / 64, origin[1] + at / 8 % 8, origin[2] + at % 8});
  }
}

std::uint64_t mixed(std::uint64_t v) {  // SplitMix64's finaliser
  v = (v ^ (v >> 30U)) * 0xBF58476D1CE4E5B9U;
  v = (v ^ (v >> 27U)) * 0x94D049BB133111EBU;
  return v ^ (v >> 31U);
}

std::uint64_t active_in_tile(const Tile& tile) {
  const auto size = static_cast<std::uint64_t>(tile.size);
  return tile.active ? size * size * size : 0;
}

}  // namespace

MemorySlabs::MemorySlabs(std::span<const std::byte> samples, SampleType type, Index3 dims,
                         Layout layout)
    : layout_(layout) {
  volume_.format = "memory";
  volume_.type = type;
  volume_.endian = layout.endian;
  volume_.lattice = {box_of({0, 0, 0}, dims), layout.to_world};
  const std::size_t size = sample_size(type);
  const std::size_t row = static_cast<std::size_t>(dims[0]) * size;
  const std::size_t n_rows = static_cast<std::size_t>(dims[1]) * static_cast<std::size_t>(dims[2]);
  assert(samples.size() == row * n_rows);
  row_stride_ = row + layout.row_padding;
  bytes_.assign(layout.lead + row_stride_ * n_rows, std::byte{0xA5});
  for (std::size_t r = 0; r < n_rows; ++r) {
    std::byte* out = bytes_.data() + layout.lead + r * row_stride_;
    std::copy_n(samples.data() + r * row, row, out);
    for (std::size_t at = 0; layout.endian != std::endian::native && at < row; at += size) {
      std::reverse(out + at, out + at + size);
    }
  }
}

void MemorySlabs::read(std::int32_t k0, std::int32_t k1, Slab& out) const {
  assert(0 <= k0 && k0 <= k1 && k1 <= volume_.lattice.dims()[2]);
  const std::size_t plane = row_stride_ * static_cast<std::size_t>(volume_.lattice.dims()[1]);
  out.k0 = k0;
  out.row_stride_bytes = row_stride_;
  out.planes.clear();
  for (std::int32_t k = k0; k < k1; ++k) {
    out.planes.push_back(bytes_.data() + layout_.lead + plane * static_cast<std::size_t>(k));
  }
}

MemoryLeaves::Choose MemoryLeaves::sparsest() {
  return [](const Index3&) { return Keep::absent; };
}

MemoryLeaves::Choose MemoryLeaves::seeded(std::uint64_t seed) {
  return [seed](const Index3& origin) {
    std::uint64_t hash = mixed(seed + 1);
    for (const std::int32_t c : origin) {
      hash = mixed(hash ^ static_cast<std::uint32_t>(c));
    }
    return static_cast<Keep>(hash % 3);
  };
}

MemoryLeaves::MemoryLeaves(std::span<const std::byte> samples, SampleType type, Index3 dims,
                           Index3 origin, Scalar background, const Affine& to_world,
                           const Choose& choose)
    : background_(background) {
  const IndexBox array = box_of(origin, dims);
  volume_.format = "memory";
  volume_.type = type;
  volume_.lattice = {array, to_world};
  volume_.n_active = 0;
  assert(samples.size() == sample_size(type) * index_in(array, array.hi) + sample_size(type));
  for (std::int32_t z = origin[2]; z <= array.hi[2]; z += 8) {
    for (std::int32_t y = origin[1]; y <= array.hi[1]; y += 8) {
      for (std::int32_t x = origin[0]; x <= array.hi[0]; x += 8) {
        assert(x % 8 == 0 && y % 8 == 0 && z % 8 == 0);
        add_block(samples, array, {x, y, z}, choose);
      }
    }
  }
}

void MemoryLeaves::add_block(std::span<const std::byte> samples, const IndexBox& array,
                             const Index3& origin, const Choose& choose) {
  const std::size_t size = sample_size(volume_.type);
  std::vector<std::byte> values(size * kLeafSamples);
  std::array<std::uint64_t, 8> active{};
  for_block(origin, [&](std::size_t n, const Index3& p) {
    const bool in_array = array.contains(p);
    const std::byte* from =
        in_array ? samples.data() + size * index_in(array, p) : background_.bytes.data();
    std::memcpy(values.data() + size * n, from, size);
    active[n / 64] |= std::uint64_t{in_array} << (n % 64);
  });
  const bool full =
      std::all_of(active.begin(), active.end(), [](auto w) { return w == ~std::uint64_t{0}; });
  const bool uniform =
      std::equal(values.begin() + static_cast<std::ptrdiff_t>(size), values.end(), values.begin());
  const Keep keep = full && uniform ? choose(origin) : Keep::leaf;
  if (keep == Keep::leaf) {
    origins_.push_back(origin);
    values_.insert(values_.end(), values.begin(), values.end());
    active_.push_back(active);
    for (const std::uint64_t word : active) {
      *volume_.n_active += static_cast<std::uint64_t>(std::popcount(word));
    }
    return;
  }
  Tile tile{origin, 8, {}, true};
  std::memcpy(tile.value.bytes.data(), values.data(), size);
  if (keep == Keep::tile || tile.value != background_) {
    add_tile(tile);
  }
}

void MemoryLeaves::add_tile(const Tile& tile) {
  tiles_.push_back(tile);
  *volume_.n_active += active_in_tile(tile);
  for (std::size_t a = 0; tile.active && a < 3; ++a) {
    IndexBox& box = volume_.lattice.box;
    box.lo[a] = std::min(box.lo[a], tile.origin[a]);
    box.hi[a] = std::max(box.hi[a], tile.origin[a] + tile.size - 1);
  }
}

void MemoryLeaves::deactivate(const std::function<bool(const Index3&)>& where) {
  for (std::size_t leaf = 0; leaf < origins_.size(); ++leaf) {
    for_block(origins_[leaf], [&](std::size_t n, const Index3& p) {
      const std::uint64_t bit = std::uint64_t{1} << (n % 64);
      if ((active_[leaf][n / 64] & bit) != 0 && where(p)) {
        active_[leaf][n / 64] ^= bit;
        --*volume_.n_active;
      }
    });
  }
}

const std::byte* MemoryLeaves::leaf_values(std::size_t n, std::byte* /*scratch*/) const {
  return values_.data() + n * kLeafSamples * sample_size(volume_.type);
}

std::array<std::uint64_t, 8> MemoryLeaves::leaf_active(std::size_t n) const { return active_[n]; }

}  // namespace mc::test
