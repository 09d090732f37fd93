// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <span>

#include "extract/sparse/block_index.hpp"

// Neighbours without a search: as a walk goes up through an ordered list, so do the places of the
// blocks beside it.

namespace mc::extraction {

inline constexpr std::size_t kNoBlock = static_cast<std::size_t>(-1);

/// The places, in a list ordered by (z, y, x), of the kWidth^3 blocks from a block upwards.
template <std::size_t kWidth>
class BlockWalk {
 public:
  explicit BlockWalk(std::span<const SurfaceBlock> blocks) : blocks_(blocks) {}

  /// Moves to block n, never back. Cost: the way up in each row, or a search the first time.
  void move_to(std::size_t n) {
    assert(n < blocks_.size());
    const Index3 at = blocks_[n].at;
    for (std::size_t row = 0; row < kRows; ++row) {
      Index3 block{at[0], at[1] + static_cast<std::int32_t>(row % kWidth),
                   at[2] + static_cast<std::int32_t>(row / kWidth)};
      std::size_t& p = place_[row];
      if (!begun_) p = search(block);
      while (p < blocks_.size() && comes_before(blocks_[p].at, block)) ++p;
      std::size_t next = p;
      for (std::size_t x = 0; x < kWidth; ++x, ++block[0]) {
        const bool there = next < blocks_.size() && same(blocks_[next].at, block);
        found_[row * kWidth + x] = there ? next++ : kNoBlock;
      }
    }
    begun_ = true;
  }

  /// The place of a block, or kNoBlock.
  [[nodiscard]] std::size_t at(std::size_t x, std::size_t y, std::size_t z) const {
    assert(x < kWidth && y < kWidth && z < kWidth);
    return found_[(z * kWidth + y) * kWidth + x];
  }

 private:
  static constexpr std::size_t kRows = kWidth * kWidth;

  [[nodiscard]] std::size_t search(const Index3& block) const {
    const auto found = std::lower_bound(
        blocks_.begin(), blocks_.end(), block,
        [](const SurfaceBlock& a, const Index3& b) { return comes_before(a.at, b); });
    return static_cast<std::size_t>(found - blocks_.begin());
  }

  std::span<const SurfaceBlock> blocks_;
  bool begun_ = false;
  std::array<std::size_t, kRows> place_{};
  std::array<std::size_t, kRows * kWidth> found_{};
};

}  // namespace mc::extraction
