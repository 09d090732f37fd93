// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "extract/cubes/edge_vertex.hpp"
#include "extract/sparse/block_index.hpp"
#include "mc/field.hpp"

// Samples of a block and of the ring of blocks around it.

namespace mc::extraction {

template <class T>
class BlockSampler {
 public:
  /// Scratch that it needs.
  static constexpr std::size_t kScratchBytes = 27 * LeafReader::kLeafSamples * sizeof(double);

  BlockSampler(const LeafReader& reader, const BlockIndex& index, const IndexBox& box,
               std::byte* scratch)
      : reader_(reader), index_(index), box_(box), scratch_(scratch) {}

  /// `values` are the block's own, null where it is constant.
  void move_to(const Index3& block, const std::byte* values) {
    corner_ = {block[0] - 1, block[1] - 1, block[2] - 1};
    known_ = values != nullptr ? 1U << kMiddle : 0;
    values_[kMiddle] = values;
  }
  [[nodiscard]] const IndexBox& box() const noexcept { return box_; }

  /// The sample at a lattice index, in the ring at most.
  [[nodiscard]] T raw(const Index3& p) const {
    const Index3 block = block_of(p);
    const std::int32_t n =
        (block[0] - corner_[0]) + 3 * (block[1] - corner_[1]) + 9 * (block[2] - corner_[2]);
    return value(values(static_cast<std::size_t>(n)), value_index(p[0], p[1], p[2]));
  }
  [[nodiscard]] Real<T> at(const Index3& p) const {
    return static_cast<Real<T>>(field::number(raw(p)));
  }

  /// Central differences at (x, y, z) of the block, each in 0..8, as EdgeVertices::gradient() makes
  /// them of samples that the box holds.
  [[nodiscard]] std::array<Real<T>, 3> gradient(int x, int y, int z) const {
    const auto difference = [](Real<T> behind, Real<T> before) {
      return (behind - before) * Real<T>{0.5};
    };
    return {difference(near(x + 1, y, z), near(x - 1, y, z)),
            difference(near(x, y + 1, z), near(x, y - 1, z)),
            difference(near(x, y, z + 1), near(x, y, z - 1))};
  }

  /// The values of the block itself, or of the next along an axis: `source` = 1 + axis.
  [[nodiscard]] const std::byte* source(std::size_t source) const {
    assert(source < 4);
    static constexpr std::size_t kPlace[4] = {kMiddle, kMiddle + 1, kMiddle + 3, kMiddle + 9};
    return values(kPlace[source]);
  }
  [[nodiscard]] static Real<T> real(const std::byte* values, std::size_t at) {
    return static_cast<Real<T>>(field::number(value(values, at)));
  }

 private:
  static constexpr std::size_t kMiddle = 13;  // of the ring's 27 blocks

  static T value(const std::byte* values, std::size_t at) {
    return field::load_sample<T, false>(values + at * sizeof(T));
  }
  /// Index of a sample among its block's values.
  static std::size_t value_index(std::int32_t x, std::int32_t y, std::int32_t z) {
    return field::leaf_index(x & 7, y & 7, z & 7);
  }
  /// The sample at (x, y, z) from the block's origin, each in -8..15.
  [[nodiscard]] Real<T> near(int x, int y, int z) const {
    const int n = static_cast<int>(kMiddle) + (x >> 3) + 3 * (y >> 3) + 9 * (z >> 3);
    return real(values(static_cast<std::size_t>(n)), value_index(x, y, z));
  }
  /// The values of block n of the ring; of a constant block, as many copies.
  const std::byte* values(std::size_t n) const {
    assert(n < 27);
    if ((known_ >> n & 1U) == 0) look_up(n);
    return values_[n];
  }
  void look_up(std::size_t n) const {
    const auto at = static_cast<std::int32_t>(n);
    const Block found =
        index_.at({corner_[0] + at % 3, corner_[1] + at / 3 % 3, corner_[2] + at / 9});
    std::byte* scratch = scratch_ + n * LeafReader::kLeafSamples * sizeof(double);
    if (found.leaf == Block::kConstant) {
      std::fill_n(reinterpret_cast<T*>(scratch), LeafReader::kLeafSamples, found.value.as<T>());
      values_[n] = scratch;
    } else {
      values_[n] = reader_.leaf_values(found.leaf, scratch);
    }
    known_ |= 1U << n;
  }

  const LeafReader& reader_;
  const BlockIndex& index_;
  IndexBox box_;
  std::byte* scratch_;
  Index3 corner_{};
  // Filled as they are asked for.
  mutable std::uint32_t known_ = 0;
  mutable std::array<const std::byte*, 27> values_{};
};

}  // namespace mc::extraction
