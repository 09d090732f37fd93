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

/// The numbers of an instruction.
using Numbers = std::array<float, 6>;

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

/// A solid's instruction. Where it turns about an axis, the coordinates and the centre are still to
/// be permuted so that the second runs along it.
struct SolidCode {
  Op op = Op::sphere;
  Numbers numbers{};
  bool turns_about_axis = false;
};
[[nodiscard]] SolidCode solid_code(const Node& solid);

/// The 3 x 4 matrix, row by row, that takes world points into the frame of a capsule, given by its
/// ends and radii: the first end is the origin, the second axis points to the other one. A capsule
/// along an axis of the world gives a permutation.
[[nodiscard]] std::vector<float> capsule_frame(std::span<const float> list);

}  // namespace mc::graph
