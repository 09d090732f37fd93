// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

// A compiled graph: straight-line instructions over rows of floats ("registers"). Coordinates are
// registers too, so fractals and warps need nothing special here: the compiler emits their sources
// again over other coordinates.

namespace mc::graph {

enum class Op : std::uint8_t {
  fill,  // p0
  x,     // world coordinates of the row
  y,
  z,
  add,  // a + b
  sub,
  mul,
  div,
  min,  // b < a ? b : a
  max,  // b > a ? b : a
  pow,
  mod,
  abs,
  neg,
  sqrt,
  floor,
  fract,
  sin,
  clamp,         // to [p0, p1]
  remap,         // (a - p0) * p1 + p2
  smoothstep,    // t = clamp((a - p0) / p1)
  mix,           // a + (b - a) * c
  select,        // c < p0 ? a : b
  blend,         // a + (b - a) * smoothstep of c over [p0, p0 + p1]
  curve,         // b where a < p0, else the cubic p1 + p2 t + p3 t^2 + p4 t^3, t = a - p0
  terrace,       // steps of p0 from p3, flat up to p1 of a step, then rising by p2 a step
  repeat,        // a - p0 * n, n the nearest whole number of periods within [p1, p2]
  scale,         // a * p0
  accumulate,    // a + b * p0
  multiply_add,  // a + b * c, rounded twice
  weigh,         // fbm's next amplitude from amplitude a and noise b; p0 gain, p1 weighted
  offset,        // p0 + a
  mirror,        // p0 - a
  smooth_min,    // of a, b; radius p0
  smooth_max,
  perlin2,  // coordinates a, b (, c); p0 frequency; seed
  perlin3,
  simplex2,
  simplex3,
  unity2,
  sphere,  // signed distances, positive inside; coordinates a, b, c; p as Node::numbers
  box,
  plane,
  torus,      // from here: coordinates permuted so that b runs along the axis
  cylinder,   // p3 radius, p4 half the height
  cone,       // p3, p4 radii, p5 half the height
  capsule,    // from the origin along b; p0 length, p1, p2 radii, p3, p4 slope: sine and cosine
  ellipsoid,  // p as Node::numbers
  gyroid,     // p0..p2 centre, p3 radians a unit
};

struct Instruction {
  Op op = Op::fill;
  std::uint32_t out = 0;
  std::array<std::uint32_t, 3> in{};
  std::uint8_t n_in = 0;
  std::uint32_t seed = 0;
  std::array<float, 6> p{};
};

/// Samples are computed in pieces of rows of this many, so that registers stay in the cache.
inline constexpr std::size_t kPiece = 256;

struct Program {
  std::vector<Instruction> once_a_plane;  // do not depend on y
  std::vector<Instruction> once_a_row;
  std::uint32_t n_registers = 0;
  std::uint32_t result = 0;
};

}  // namespace mc::graph
