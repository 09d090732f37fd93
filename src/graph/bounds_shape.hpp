// SPDX-License-Identifier: MIT
#pragma once

#include "graph/bounds.hpp"

// Bounds of solids, for ops.def: over known coordinates.

namespace mc::graph {

[[nodiscard]] Interval sphere_bounds(const Instruction& instruction, const Interval (&at)[3]);
[[nodiscard]] Interval box_bounds(const Instruction& instruction, const Interval (&at)[3]);
[[nodiscard]] Interval plane_bounds(const Instruction& instruction, const Interval (&at)[3]);
[[nodiscard]] Interval torus_bounds(const Instruction& instruction, const Interval (&at)[3]);
[[nodiscard]] Interval cylinder_bounds(const Instruction& instruction, const Interval (&at)[3]);

/// Of an exact distance, which falls and rises by no more than the way: about its value in the
/// middle.
[[nodiscard]] Interval distance_bounds(const Instruction& instruction, const Interval (&at)[3]);

[[nodiscard]] Interval ellipsoid_bounds(const Instruction& instruction, const Interval (&at)[3]);
[[nodiscard]] Interval gyroid_bounds(const Instruction& instruction, const Interval (&at)[3]);

}  // namespace mc::graph
