// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "graph/program.hpp"

// One instruction over a row of n samples, on the SIMD target in use. Inputs and output do not
// overlap, and have room for n rounded up to kRowStep: whole vectors are read and written. The
// formulas are final: mc-volume(5) states them, tests pin their bits, the same on every target.

namespace mc::graph {

using Row = const float* __restrict;
using OutRow = float* __restrict;

/// No target's vector holds more samples.
inline constexpr std::size_t kRowStep = 16;
static_assert(kPiece % kRowStep == 0);

/// Any instruction but the coordinates, which are not made from rows.
void any_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
             OutRow out) noexcept;

/// Arithmetic, min, max, fractal sums, smooth combinations.
void arithmetic_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
                    OutRow out) noexcept;

/// Signed distances, positive inside, world units.
void solid_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
               OutRow out) noexcept;

/// Gradient noises; the range is [-1, 1] but for rounding. Of all noises: coordinates times
/// frequency are held at 2^30 cells (simplex: 2^28); NaN gives NaN. unity2 is Mathf.PerlinNoise(x,
/// y). Source   Perlin, "Improving noise", SIGGRAPH 2002; differs: an integer hash instead of the
///          permutation table, in two dimensions eight gradients of its own. Perlin, "Noise
///          hardware", 2001; Gustavson, "Simplex noise demystified", 2005; differs: kernel
///          (1/2 - r^2)^4 in three dimensions too, which ends before the next simplex, so that the
///          noise is continuous; and the hash and gradients of perlin. Spencer, "OpenSimplex2",
///          2019; differs: the same kernel, hash and, in three dimensions, gradients.
void gradient_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
                  OutRow out) noexcept;

/// A picture laid over the coordinates; its pixels' centres are half a pixel from its edges.
void heightmap_row(const Instruction& instruction, Row u, Row v, Row unused, std::size_t n,
                   OutRow out) noexcept;

/// A volume at places of the world; an integer index is a sample's own place.
void volume_row(const Instruction& instruction, Row x, Row y, Row z, std::size_t n,
                OutRow out) noexcept;

/// White noise, and values blended between lattice points; the range is [-1, 1].
/// Source   Perlin's fade; Catmull and Rom, "A class of local interpolating splines", 1974.
void value_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
               OutRow out) noexcept;

/// Distances in cells to points, one of which lies in each cell.
/// Source   Worley, "A cellular texture basis function", SIGGRAPH 1996; differs: one point a cell,
///          and all cells are looked at that can hold a nearer one.
void cellular_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
                  OutRow out) noexcept;

}  // namespace mc::graph
