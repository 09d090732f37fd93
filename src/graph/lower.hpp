// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <span>
#include <vector>

#include "graph/program.hpp"
#include "mc/graph.hpp"

// What the compiler works out from a node's numbers before it emits instructions, in double and
// without the C library, so that the bits are the same everywhere.

namespace mc::graph {

/// Pieces for Op::curve, from left to right; the value left of the first is `first`, from `end_x`
/// on it is `last`.
struct CurvePieces {
  float first = 0;
  std::vector<Numbers> pieces;
  float end_x = 0;
  float last = 0;
};

/// A curve through points (x, y, x, y, ...), x rising, held beyond the ends.
/// Source   smooth: the monotone cubic of Fritsch and Carlson 1980 with Butland's slopes (Fritsch
///          and Butland 1984), level at both ends. It never leaves the range of its points.
[[nodiscard]] CurvePieces curve_pieces(std::span<const float> points, CurveShape shape);

/// Steps at rising levels: level up to 1 - ramp of the way to the next, then straight up to it.
[[nodiscard]] CurvePieces terrace_pieces(std::span<const float> levels, float ramp);

/// What Op::capsule takes.
struct Capsule {
  /// The 3 x 4 matrix, row by row, that takes world points into the capsule's frame: the first end
  /// is the origin, the second axis points to the other one. A capsule along an axis of the world
  /// gives a permutation.
  std::vector<float> frame;
  Numbers numbers;
};

/// From the ends and the radii there.
[[nodiscard]] Capsule capsule_of(std::span<const float> list);

}  // namespace mc::graph
