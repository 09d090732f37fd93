// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "edit/world.hpp"

namespace mc::edit {

/// Steps back and forth. A step holds, for each block that it changed, the block of the other time;
/// taking it swaps them.
class History {
 public:
  explicit History(World& world) : world_(world) {}

  void begin_group();
  void end_group();
  /// What apply() does lies between these two.
  void begin_edit();
  void end_edit(const IndexBox& changed);

  /// Puts a block (none: takes it away) into `layer`, and keeps what was there for undo.
  void put(Layer& layer, const Index3& at, BlockPtr block);
  /// Drops all blocks of samples and puts `value` under them.
  void fill(const Scalar& value);

  /// Each step's changed boxes are added to `dirty`. Returns how many steps were taken.
  std::size_t undo(std::size_t count, std::vector<IndexBox>& dirty);
  std::size_t redo(std::size_t count, std::vector<IndexBox>& dirty);
  void keep(std::size_t n_steps);

 private:
  struct Change {
    Layer* layer;
    Index3 at;
    BlockPtr block;
  };
  struct Fill {
    BlockMap blocks;
    std::optional<Scalar> value;
  };
  /// Blocks, then perhaps a fill, which takes all.
  struct Part {
    std::vector<Change> changes;
    std::unique_ptr<Fill> fill;
  };
  struct Step {
    std::vector<Part> parts;
    std::vector<IndexBox> boxes;
  };

  void swap(Part& part);
  void swap_fill(Fill& fill);
  void discard(Step& step);
  void open();
  void close();

  World& world_;
  std::deque<Step> done_;
  std::deque<Step> undone_;  // the last one is next
  Step open_step_;
  std::size_t depth_ = 0;
  std::size_t most_ = std::numeric_limits<std::size_t>::max();
  std::uint64_t id_ = 0;  // of the open step
};

}  // namespace mc::edit
