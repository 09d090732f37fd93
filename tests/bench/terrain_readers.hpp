// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "mc/field.hpp"

// A terrain of any size that needs no memory of that size: the height of the ground above a sample
// is a sum of two tables. Dense, or sparse as a level set is: leaves near the surface, tiles below
// it, background above.

namespace mc::bench {

/// Heights in samples, along j; positive values lie in the ground.
class Terrain {
 public:
  explicit Terrain(const Index3& dims) : dims_(dims), along_i_(size(0)), along_k_(size(2)) {
    const double n = dims[1];
    for (std::size_t i = 0; i < along_i_.size(); ++i) {
      const auto x = static_cast<double>(i);
      along_i_[i] = static_cast<float>(n / 2 + n / 12 * std::sin(17 * x / n) + 2 * std::sin(x / 5));
    }
    for (std::size_t k = 0; k < along_k_.size(); ++k) {
      const auto z = static_cast<double>(k);
      along_k_[k] = static_cast<float>(n / 10 * std::sin(13 * z / n) + 2 * std::cos(z / 7));
    }
  }
  [[nodiscard]] const Index3& dims() const { return dims_; }
  [[nodiscard]] float height(std::int32_t i, std::int32_t k) const {
    return along_i_[static_cast<std::size_t>(i)] + along_k_[static_cast<std::size_t>(k)];
  }
  /// Samples of part of a row.
  void fill_row(std::int32_t i0, std::int32_t j, std::int32_t k, std::span<float> out) const {
    const float* const heights = along_i_.data() + i0;
    const float base = along_k_[static_cast<std::size_t>(k)] - static_cast<float>(j);
    for (std::size_t n = 0; n < out.size(); ++n) out[n] = heights[n] + base;
  }

 private:
  [[nodiscard]] std::size_t size(std::size_t a) const { return static_cast<std::size_t>(dims_[a]); }

  Index3 dims_;
  std::vector<float> along_i_, along_k_;
};

class TerrainSlabs final : public SlabReader {
 public:
  explicit TerrainSlabs(const Terrain& terrain) : terrain_(terrain) {
    const Index3& n = terrain.dims();
    volume_.lattice.box = {{0, 0, 0}, {n[0] - 1, n[1] - 1, n[2] - 1}};
  }
  [[nodiscard]] const Volume& volume() const override { return volume_; }
  [[nodiscard]] bool rereads_cheaply() const override { return false; }

  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override {
    const IndexBox planes = planes_of(volume_.lattice.box, k0, k1);
    out.allocate(planes, sizeof(float));
    read_box(planes, out.storage);
  }
  [[nodiscard]] bool reads_boxes_cheaply() const override { return true; }
  void read_box(const IndexBox& box, std::span<std::byte> out) const override {
    const auto n = static_cast<std::size_t>(box.extent(0));
    auto* to = reinterpret_cast<float*>(out.data());
    for (std::int32_t k = box.lo[2]; k <= box.hi[2]; ++k) {
      for (std::int32_t j = box.lo[1]; j <= box.hi[1]; ++j, to += n) {
        terrain_.fill_row(box.lo[0], j, k, {to, n});
      }
    }
  }

 private:
  const Terrain& terrain_;
  Volume volume_;
};

/// Values are held within +-kBand. Dims are multiples of 8.
class TerrainLeaves final : public LeafReader {
 public:
  static constexpr float kBand = 3;

  explicit TerrainLeaves(const Terrain& terrain) {
    const Index3& n = terrain.dims();
    volume_.lattice.box = {{0, 0, 0}, {n[0] - 1, n[1] - 1, n[2] - 1}};
    for (std::int32_t k = 0; k < n[2]; k += 8) {
      for (std::int32_t j = 0; j < n[1]; j += 8) {
        for (std::int32_t i = 0; i < n[0]; i += 8) add_block(terrain, {i, j, k});
      }
    }
  }
  [[nodiscard]] const Volume& volume() const override { return volume_; }
  [[nodiscard]] Scalar background() const override { return Scalar::of(-kBand); }
  [[nodiscard]] std::span<const Index3> leaves() const override { return origins_; }
  const std::byte* leaf_values(std::size_t n, std::byte* /*scratch*/) const override {
    return reinterpret_cast<const std::byte*>(values_.data() + n * kLeafSamples);
  }
  [[nodiscard]] std::array<std::uint64_t, 8> leaf_active(std::size_t /*n*/) const override {
    std::array<std::uint64_t, 8> all;
    all.fill(~std::uint64_t{0});
    return all;
  }
  [[nodiscard]] std::span<const Tile> tiles() const override { return tiles_; }

 private:
  void add_block(const Terrain& terrain, const Index3& at) {
    float low = terrain.height(at[0], at[2]), high = low;
    for (std::int32_t n = 0; n < 64; ++n) {
      const float h = terrain.height(at[0] + n % 8, at[2] + n / 8);
      low = std::min(low, h);
      high = std::max(high, h);
    }
    const auto j = static_cast<float>(at[1]);
    if (high - j <= -kBand) return;
    if (low - (j + 7) >= kBand) {
      tiles_.push_back({at, 8, Scalar::of(kBand), false});
      return;
    }
    origins_.push_back(at);
    for (std::int32_t n = 0; n < 512; ++n) {  // z fastest
      const std::int32_t i = n / 64, y = n / 8 % 8, z = n % 8;
      const float v = terrain.height(at[0] + i, at[2] + z) - static_cast<float>(at[1] + y);
      values_.push_back(std::clamp(v, -kBand, kBand));
    }
  }

  Volume volume_;
  std::vector<Index3> origins_;
  std::vector<float> values_;
  std::vector<Tile> tiles_;
};

}  // namespace mc::bench
