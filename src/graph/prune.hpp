// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "graph/bounds.hpp"
#include "graph/program.hpp"

// Shorter programs for blocks: where bounds say which input of a minimum wins, or that a value is
// one number, the rest need not be run.

namespace mc::graph {

/// The same value in fewer steps, where the bounds of the inputs and of the value itself allow it:
/// bit by bit, also the signs of zeros.
[[nodiscard]] Instruction simplified(const Instruction& instruction,
                                     const std::array<Interval, 3>& inputs,
                                     Interval value) noexcept;

/// Prunes parts of one program again and again. Keeps its memory.
class Pruner {
 public:
  explicit Pruner(const Program& program) : program_(program), live_(program.code.size(), 0) {}

  /// What of `code`, which ends with or before the result, is needed where all of its values and
  /// their inputs are within `bounds`, simplified, in the same order. A value stays in its
  /// register: its inputs live at least as long as in the whole program.
  void prune(std::span<const Instruction> code, const std::vector<Interval>& bounds,
             std::vector<Instruction>& out);

 private:
  const Program& program_;
  std::vector<std::uint8_t> live_;
};

}  // namespace mc::graph
