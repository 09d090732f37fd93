// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <vector>

#include "extract/sparse/block_index.hpp"
#include "mc/field.hpp"

// Leaves lie about in memory, where no core sees the next one coming: whoever goes through them
// asks for them a few leaves ahead.

namespace mc::extraction {

/// Leaves that were asked for and not yet used.
class LeafQueue {
 public:
  static constexpr std::size_t kAhead = 4;
  static constexpr std::size_t kScratchBytes = kAhead * LeafReader::kLeafSamples * sizeof(double);

  explicit LeafQueue(const LeafReader& reader)
      : reader_(reader),
        leaf_bytes_(LeafReader::kLeafSamples * sample_size(reader.volume().type)),
        scratch_(kScratchBytes) {}

  void clear() { pushed_ = popped_ = 0; }
  /// Begins to read a leaf, or stands for none. At most kAhead wait at once.
  void push(std::size_t leaf) {
    assert(pushed_ < popped_ + kAhead);
    const std::size_t slot = pushed_++ % kAhead;
    values_[slot] = nullptr;
    if (leaf == Block::kConstant) return;
    std::byte* scratch = scratch_.data() + slot * (kScratchBytes / kAhead);
    values_[slot] = reader_.leaf_values(leaf, scratch);
    for (std::size_t at = 0; values_[slot] != scratch && at < leaf_bytes_; at += 64) {
      __builtin_prefetch(values_[slot] + at);
    }
  }
  /// The values of the first, good until the next push; null for none.
  const std::byte* pop() {
    assert(popped_ < pushed_);
    return values_[popped_++ % kAhead];
  }

 private:
  const LeafReader& reader_;
  std::size_t leaf_bytes_;
  std::size_t pushed_ = 0, popped_ = 0;
  std::vector<std::byte> scratch_;
  std::array<const std::byte*, kAhead> values_{};
};

/// The numbers of leaves, for blocks that are asked for in ascending order.
class LeafWalk {
 public:
  /// Begins at a block.
  LeafWalk(std::span<const Index3> origins, const Index3& block) : origins_(origins) {
    const Index3 origin = origin_of(block);
    place_ = static_cast<std::size_t>(
        std::lower_bound(origins.begin(), origins.end(), origin, comes_before) - origins.begin());
  }
  /// The number of the leaf, or Block::kConstant.
  std::uint32_t find(const Index3& block) {
    const Index3 origin = origin_of(block);
    while (place_ < origins_.size() && comes_before(origins_[place_], origin)) ++place_;
    const bool there = place_ < origins_.size() && same(origins_[place_], origin);
    return there ? static_cast<std::uint32_t>(place_) : Block::kConstant;
  }

 private:
  std::span<const Index3> origins_;
  std::size_t place_ = 0;
};

}  // namespace mc::extraction
