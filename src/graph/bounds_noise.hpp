// SPDX-License-Identifier: MIT
#pragma once

#include "graph/bounds.hpp"

// Bounds of noises, for ops.def: over known coordinates.

namespace mc::graph {

/// Of a noise at frequency 1. `slope` bounds its steepness: the largest sum over the corners of a
/// cell of what each gives with its worst gradient, in the worst direction, found on a grid of
/// 1/200 (three dimensions: 1/40) cell and rounded up by two hundredths. Value noises: the root of
/// the axes' number times the steepest blend along one; the sums of opensimplex2 were taken of
/// lengths, whatever the direction. Distances to points: as steep as the metric, their difference
/// twice. `bend` bounds the second derivative along each axis, found the same way, simplex noises
/// at 400,000 places and rounded up by a twentieth; 0 where there is none everywhere.
struct Shape {
  float slope;
  float bend;
};

/// Bounds of a continuous noise.
/// Cost     of a noise that varies little over the box, up to 32 of its samples.
[[nodiscard]] Interval noise_bounds(const Instruction& instruction, const Interval (&at)[3],
                                    Shape shape);

/// Bounds of cellular noise; of what jumps between points, the whole range.
[[nodiscard]] Interval cellular_bounds(const Instruction& instruction, const Interval (&at)[3]);

/// All values that a noise can take anywhere.
[[nodiscard]] Interval whole_range(const Instruction& instruction);

}  // namespace mc::graph
