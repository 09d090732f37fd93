// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mc/graph.hpp"

// A compiled graph: straight-line instructions, each of which makes one value from values before
// it, over rows of floats. Coordinates are values too, so fractals and warps need nothing special
// here: the compiler emits their sources again over other coordinates.

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
  curve,         // b where a < p0, else p1 + p2 t + p3 t^2 + p4 t^3 with t = a - p0, at most p5
  terrace,       // steps of p0 from p3, flat up to p1 of a step, then rising by p2 a step
  repeat,        // a - p0 * n, n the nearest whole number of periods within [p1, p2]
  scale,         // a * p0
  accumulate,    // a + b * p0
  multiply_add,  // a + b * c, rounded twice
  weigh,         // a fractal's next amplitude from amplitude a, octave b; p0 gain, p1 weighted
  ridge,         // 1 - 2 |a|
  billow,        // 2 |a| - 1
  pingpong,      // (a + 1) * p0, folded to and fro in [-1, 1]
  offset,        // p0 + a
  mirror,        // p0 - a
  smooth_min,    // of a, b; radius p0
  smooth_max,
  perlin2,  // coordinates a, b (, c); p0 frequency; seed
  perlin3,
  simplex2,
  simplex3,
  open_simplex2,
  open_simplex3,
  unity2,
  white2,
  white3,
  value2,
  value3,
  value_cubic2,
  value_cubic3,
  cellular2,  // also p1 jitter, p2 CellReturn, p3 CellMetric
  cellular3,
  sphere,  // signed distances, positive inside; coordinates a, b, c; p as Node::numbers
  box,
  plane,
  torus,      // from here: coordinates permuted so that b runs along the axis
  cylinder,   // p3 radius, p4 half the height
  cone,       // p3, p4 radii, p5 half the height
  capsule,    // from the origin along b; p0 length, p1, p2 radii, p3, p4 slope: sine and cosine
  ellipsoid,  // p as Node::numbers
  gyroid,     // p0..p2 centre, p3 radians a unit
  heightmap,  // coordinates a, b; p as Node::numbers, but pixels a unit for sizes; data
  volume,     // coordinates a, b, c; data
  copy,       // a; of pruned programs only
};

/// A value is named by its place in Program::code.
using Value = std::uint32_t;

/// Samples, and how a node reads them. Its pointer is what an instruction holds.
struct DataUse {
  std::shared_ptr<const Raster> raster;         ///< of a heightmap
  std::shared_ptr<const SampledVolume> volume;  ///< of a volume
  Wrap wrap = Wrap::clamp;
  Filter filter = Filter::linear;
  std::optional<float> outside;  ///< what samples beyond a volume are; unset: its nearest one
  float least = 0;               ///< of all of these; NaN where one is not finite
  float greatest = 0;
};

struct Instruction {
  Op op = Op::fill;
  Value out = 0;
  std::array<Value, 3> in{};
  std::uint8_t n_in = 0;
  std::uint32_t seed = 0;
  std::array<float, 6> p{};
  const DataUse* data = nullptr;  ///< one of Program::data
};

/// Samples are computed in pieces of this many, so that registers stay in the cache.
inline constexpr std::size_t kPiece = 256;

struct Program {
  std::vector<Instruction> code;     ///< value n is made by code[n]
  std::size_t n_flat = 0;            ///< the first so many do not change along y
  std::vector<bool> uniform;         ///< of each value: whether it changes along y only
  std::vector<std::uint32_t> homes;  ///< of each value: the register that holds it
  std::uint32_t n_registers = 0;
  Value result = 0;
  std::vector<std::shared_ptr<const DataUse>> data;  ///< what instructions point to

  /// What is run once a column of samples, and what for each of them.
  [[nodiscard]] std::span<const Instruction> flat() const { return std::span(code).first(n_flat); }
  [[nodiscard]] std::span<const Instruction> deep() const {
    return std::span(code).subspan(n_flat);
  }
};

}  // namespace mc::graph
