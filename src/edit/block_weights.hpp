// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "edit/block.hpp"
#include "edit/brush.hpp"

namespace mc::edit {

/// What one place of a brush means for the samples of a block. Only rows with a reached sample hold
/// anything; the samples of such a row that are not reached have weight 0.
struct BlockWeights {
  alignas(64) std::array<double, kBlockSamples> weight;
  alignas(64) std::array<double, kBlockSamples> distance;  ///< signed, negative inside
  Mask512 reached;                                         ///< weight above 0
};

/// Calls f(row) for each row (j + 8 k) that has a sample of the mask.
template <class F>
void for_rows_of(const Mask512& mask, F&& f) {
  for (std::size_t k = 0; k < kBlockSize; ++k) {
    if (mask[k] == 0) continue;
    for (std::size_t j = 0; j < kBlockSize; ++j) {
      if ((mask[k] >> (8 * j) & 0xFFU) != 0) f(8 * k + j);
    }
  }
}

class BlockWeigher {
 public:
  BlockWeigher(const Stroke& stroke, const Edit& edit, const EditRules& rules)
      : stroke_(stroke), edit_(edit), rules_(rules) {}

  /// `group`: positions of one group, at least one. False where none reaches a sample.
  /// Threads  any number, each with its own `out`.
  bool weigh(const Index3& block, std::span<const std::uint32_t> group, BlockWeights& out) const;

 private:
  struct Rows;

  void measure(const Index3& block, const Position& at, Rows& rows) const;
  void apply_mask(const Index3& block, BlockWeights& out) const;

  const Stroke& stroke_;
  const Edit& edit_;
  const EditRules& rules_;
};

/// A graph's values at the samples of a block, x fastest; only rows that meet `part` are filled.
void sample_block(const GraphField& field, const Affine& to_place, const IndexBox& part,
                  std::span<float, kBlockSamples> out);

}  // namespace mc::edit
