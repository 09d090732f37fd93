// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "graph/program.hpp"

// What a value can be within a box of the world, without sampling it: interval arithmetic over the
// instructions of a program.

namespace mc::graph {

/// All that a value can be: finite numbers in [lo, hi]. Unknown, with NaN for both, is whatever may
/// also be infinite or NaN; every comparison with it is false.
struct Interval {
  float lo = __builtin_nanf("");
  float hi = __builtin_nanf("");

  [[nodiscard]] bool known() const { return lo <= hi; }
  /// Whether there is no other number than one. The sign of a zero is left open.
  [[nodiscard]] bool single() const { return lo == hi; }
};

/// Ranges of the three world coordinates.
using WorldBox = std::array<Interval, 3>;

/// Bounds of what an instruction makes of inputs within `a`, `b` and `c` (those it has), at places
/// within `box`.
/// Promise  they hold for the float32 numbers that the rows really give, on every target.
/// Cost     some nanoseconds; of a noise that varies little over the box, up to 32 of its samples;
///          of a volume up to 4096.
/// Source   Moore, "Interval analysis", 1966. Monotone steps are taken at the ends of the interval
///          with the same float operations: since rounding is monotone, that is exact. The others
///          are widened by more than they can be wrong.
[[nodiscard]] Interval bounds_of(const Instruction& instruction, const WorldBox& box, Interval a,
                                 Interval b, Interval c) noexcept;

}  // namespace mc::graph
