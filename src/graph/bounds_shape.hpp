// SPDX-License-Identifier: MIT
#pragma once

#include "graph/bounds.hpp"

// Bounds of the solids that are no sums of squares, for bounds_of: over known coordinates.

namespace mc::graph {

[[nodiscard]] Interval cylinder_bounds(const Instruction& instruction, const Interval (&at)[3]);

/// Of an exact distance, which falls and rises by no more than the way: about its value in the
/// middle.
[[nodiscard]] Interval distance_bounds(const Instruction& instruction, const Interval (&at)[3]);

[[nodiscard]] Interval ellipsoid_bounds(const Instruction& instruction, const Interval (&at)[3]);
[[nodiscard]] Interval gyroid_bounds(const Instruction& instruction, const Interval (&at)[3]);

}  // namespace mc::graph
