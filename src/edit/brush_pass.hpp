// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "edit/block_weights.hpp"
#include "edit/combine.hpp"
#include "edit/history.hpp"
#include "edit/operands.hpp"
#include "edit/touch_list.hpp"
#include "mc/edit.hpp"

namespace mc::edit {

/// An edit at work on the blocks that it reaches, block by block on all threads. Each block is made
/// anew beside the old one, so that all of them see the volume as it was before the pass.
class BrushPass {
 public:
  BrushPass(const Edit& edit, const EditRules& rules, const Stroke& stroke, World& world);

  /// Chooses groups [first, last) of the stroke. Errors   limit: more than `most_blocks`.
  void plan(std::uint32_t first, std::uint32_t last, std::uint64_t most_blocks);
  /// For a flatten without a plane of its own: fits one to the surface under the brush. False where
  /// there is none.
  bool find_plane();
  /// Applies the chosen groups, in `steps` steps each, and puts the blocks that changed.
  void run(std::uint32_t steps, History& history);
  /// Notes which samples would be reached.
  void measure();

  /// Of all passes so far.
  [[nodiscard]] const EditEffect& effect() const { return effect_; }

 private:
  struct Marks {
    Mask512 reached{};
    Mask512 changed{};
  };
  /// What became of a block, which takes the place of the old one where anything changed.
  struct Outcome {
    BlockPtr block;
    Marks marks;
    bool changed = false;
  };

  void apply(std::size_t n, std::uint32_t steps, Outcome& out) const;
  void load(const Index3& at, Block& out) const;
  void work(const Index3& at, std::span<const std::uint32_t> group, std::uint32_t steps,
            BlockWeights& weights, Block& block) const;
  void compare(const std::byte* before, const Mask512& active_before, Outcome& out) const;
  void note(const Index3& at, const Marks& marks);
  [[nodiscard]] Layer& layer() const;

  const Edit& edit_;
  const EditRules& rules_;
  const Stroke& stroke_;
  World& world_;
  BlockWeigher weigher_;
  Operands operands_;
  Recipe recipe_;
  std::optional<TouchList> touches_;
  EditEffect effect_;
  std::unordered_map<Index3, Marks, IndexHash> noted_;  // of several passes
};

}  // namespace mc::edit
