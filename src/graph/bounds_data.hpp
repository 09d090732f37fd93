// SPDX-License-Identifier: MIT
#pragma once

#include "graph/bounds.hpp"

// Bounds of what reads samples, for ops.def: over known coordinates.

namespace mc::graph {

/// Between the least and the greatest pixel: a straight line stays there but for rounding, the
/// spline leaves it by 9/32 of the range at most.
[[nodiscard]] Interval heightmap_bounds(const Instruction& instruction, const Interval (&at)[3]);

/// Between the least and the greatest of the samples that the coordinates reach, where they are
/// few; else of all.
[[nodiscard]] Interval volume_bounds(const Instruction& instruction, const Interval (&at)[3]);

}  // namespace mc::graph
