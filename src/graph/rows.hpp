// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "graph/program.hpp"

// One instruction over a row of n samples. Inputs and output do not overlap. The formulas are
// final: mc-volume(5) states them, tests pin their bits.

namespace mc::graph {

using Row = const float* __restrict;
using OutRow = float* __restrict;

/// Any instruction but the coordinates, which are not made from rows.
void any_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
             OutRow out) noexcept;

/// Arithmetic, min, max, fractal sums, smooth combinations.
void arithmetic_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
                    OutRow out) noexcept;

/// Signed distances, positive inside, world units.
void solid_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
               OutRow out) noexcept;

/// Gradient noise; the range is about [-1, 1]. Beyond 2^30 cells the coordinate is held; NaN gives
/// NaN.
/// Source   Perlin, "Improving noise", SIGGRAPH 2002; differs: an integer hash instead of the
///          permutation table, in two dimensions eight gradients of its own.
void perlin2_row(Row x, Row y, float frequency, std::uint32_t seed, std::size_t n,
                 OutRow out) noexcept;
void perlin3_row(Row x, Row y, Row z, float frequency, std::uint32_t seed, std::size_t n,
                 OutRow out) noexcept;

/// Simplex noise; the range is [-1, 1]. Continuous, since the kernel ends before the next simplex.
/// Source   Perlin, "Noise hardware", 2001; Gustavson, "Simplex noise demystified", 2005. Differs:
///          kernel (1/2 - r^2)^4 in three dimensions too, and the hash and gradients of perlin.
void simplex2_row(Row x, Row y, float frequency, std::uint32_t seed, std::size_t n,
                  OutRow out) noexcept;
void simplex3_row(Row x, Row y, Row z, float frequency, std::uint32_t seed, std::size_t n,
                  OutRow out) noexcept;

/// Unity's Mathf.PerlinNoise(x, y).
void unity2_row(Row x, Row y, float frequency, std::size_t n, OutRow out) noexcept;

}  // namespace mc::graph
