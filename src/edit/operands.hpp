// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>

#include "edit/block_weights.hpp"
#include "edit/edited_samples.hpp"
#include "mc/edit.hpp"

namespace mc::edit {

/// Whether an operation looks at samples around the one that it changes.
[[nodiscard]] bool looks_around(EditOp op);

/// What an operation combines samples with.
class Operands {
 public:
  /// `before`: the volume as the operation finds it.
  Operands(const Edit& edit, const EditRules& rules, const EditedSamples& before)
      : edit_(edit), rules_(rules), before_(before) {}

  /// The plane of a flatten that does not say its own; the edit is left alone where there is none.
  void set_plane(const FlattenPlane& plane) { plane_ = plane; }

  /// The operand of each sample of a block that is reached. A stamp takes the weight of samples
  /// beyond it. Threads   any number.
  void find(const Index3& block, const Position& at, BlockWeights& weights,
            std::span<double, kBlockSamples> out) const;

 private:
  void find_csg(const BlockWeights& weights, std::span<double, kBlockSamples> out) const;
  void find_noise(const Index3& block, const BlockWeights& weights,
                  std::span<double, kBlockSamples> out) const;
  void find_plane(const Index3& block, const BlockWeights& weights,
                  std::span<double, kBlockSamples> out) const;
  void find_stamp(const Index3& block, const Position& at, BlockWeights& weights,
                  std::span<double, kBlockSamples> out) const;

  const Edit& edit_;
  const EditRules& rules_;
  const EditedSamples& before_;
  std::optional<FlattenPlane> plane_{};
};

}  // namespace mc::edit
