// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see rows.hpp for what the function does.

#if defined(MC_GRAPH_ROWS_VALUE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_GRAPH_ROWS_VALUE_INL
#undef MC_GRAPH_ROWS_VALUE_INL
#else
#define MC_GRAPH_ROWS_VALUE_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <cassert>
#include <cstddef>

#include "graph/lanes-inl.hpp"
#include "graph/rows.hpp"

// Value noises: hashes of lattice points, as they are or blended between points.

HWY_BEFORE_NAMESPACE();
namespace mc::graph::HWY_NAMESPACE {
namespace {

// The largest sum of the weights' sizes, 5/4 for each axis, scales to 1.
constexpr float kCubic2Scale = 0.64F;
constexpr float kCubic3Scale = 0.512F;

/// 0, or NaN for a coordinate that is: white noise has no arithmetic to carry it along.
HWY_INLINE F nothing_of(F v) {
  const F held = clamped(v, -0x1p30F, 0x1p30F);
  return held - held;
}

/// The primed lattice coordinate nearest to v.
HWY_INLINE W nearest_primed(F v, std::uint32_t prime) {
  return split(v + set(0.5F)).cell * set(prime);
}

HWY_INLINE F white2(F x, F y, W seed) {
  const W mixed = seed ^ nearest_primed(x, kPrimeX) ^ nearest_primed(y, kPrimeY);
  return signed_unit(hash_of(mixed)) + (nothing_of(x) + nothing_of(y));
}

HWY_INLINE F white3(F x, F y, F z, W seed) {
  const W mixed =
      seed ^ nearest_primed(x, kPrimeX) ^ nearest_primed(y, kPrimeY) ^ nearest_primed(z, kPrimeZ);
  return signed_unit(hash_of(mixed)) + ((nothing_of(x) + nothing_of(y)) + nothing_of(z));
}

/// Values at both ends of a lattice edge along x, blended.
struct ValueEdge {
  W x0, x1;
  F blend;
  HWY_INLINE F at(W others) const {
    return lerp(blend, signed_unit(hash_of(x0 ^ others)), signed_unit(hash_of(x1 ^ others)));
  }
};

HWY_INLINE ValueEdge value_edge(F px) {
  const Split x = split(px);
  const W x0 = x.cell * set(kPrimeX);
  return {x0, x0 + set(kPrimeX), fade(x.rest)};
}

HWY_INLINE F value2(F px, F py, W seed) {
  const Split y = split(py);
  const W y0 = y.cell * set(kPrimeY);
  const ValueEdge edge = value_edge(px);
  return lerp(fade(y.rest), edge.at(seed ^ y0), edge.at(seed ^ (y0 + set(kPrimeY))));
}

HWY_INLINE F value3(F px, F py, F pz, W seed) {
  const Split y = split(py);
  const Split z = split(pz);
  const W y0 = y.cell * set(kPrimeY);
  const W y1 = y0 + set(kPrimeY);
  const W z0 = seed ^ (z.cell * set(kPrimeZ));
  const W z1 = seed ^ (z.cell * set(kPrimeZ) + set(kPrimeZ));
  const ValueEdge edge = value_edge(px);
  const F v = fade(y.rest);
  return lerp(fade(z.rest), lerp(v, edge.at(y0 ^ z0), edge.at(y1 ^ z0)),
              lerp(v, edge.at(y0 ^ z1), edge.at(y1 ^ z1)));
}

/// Four lattice coordinates in a row, primed, from one below the cell on, and what each weighs.
struct Knots {
  std::array<W, 4> primed;
  std::array<F, 4> weight;
};

/// Catmull and Rom's weights.
HWY_INLINE Knots knots(F v, std::uint32_t prime) {
  const Split at = split(v);
  const F t = at.rest;
  const F tt = t * t;
  const F half = set(0.5F);
  const W first = at.cell * set(prime) - set(prime);
  Knots out{{first, first + set(prime), first + set(2U * prime), first + set(3U * prime)}, {}};
  out.weight[0] = t * (t * (set(1.0F) - half * t) - half);
  out.weight[1] = set(1.0F) + tt * (set(1.5F) * t - set(2.5F));
  out.weight[2] = t * (half + t * (set(2.0F) - set(1.5F) * t));
  out.weight[3] = tt * (half * t - half);
  return out;
}

HWY_INLINE F weighed(const Knots& k, F a, F b, F c, F d) {
  return ((k.weight[0] * a + k.weight[1] * b) + k.weight[2] * c) + k.weight[3] * d;
}

HWY_INLINE F cubic_line(const Knots& x, W others) {
  const auto value = [&](std::size_t n)
                         HWY_ATTR { return signed_unit(hash_of(x.primed[n] ^ others)); };
  return weighed(x, value(0), value(1), value(2), value(3));
}

HWY_INLINE F cubic_plane(const Knots& x, const Knots& y, W others) {
  const auto line = [&](std::size_t n) HWY_ATTR { return cubic_line(x, y.primed[n] ^ others); };
  return weighed(y, line(0), line(1), line(2), line(3));
}

HWY_INLINE F value_cubic2(F px, F py, W seed) {
  return cubic_plane(knots(px, kPrimeX), knots(py, kPrimeY), seed) * set(kCubic2Scale);
}

HWY_INLINE F value_cubic3(F px, F py, F pz, W seed) {
  const Knots x = knots(px, kPrimeX);
  const Knots y = knots(py, kPrimeY);
  const Knots z = knots(pz, kPrimeZ);
  std::array<F, 4> plane{};
  for (std::size_t n = 0; n < plane.size(); ++n) {
    plane[n] = cubic_plane(x, y, seed ^ z.primed[n]);
  }
  return weighed(z, plane[0], plane[1], plane[2], plane[3]) * set(kCubic3Scale);
}

}  // namespace

void value_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n, OutRow out) {
  const float frequency = instruction.p[0];
  const W seed = set(instruction.seed);
  switch (instruction.op) {
    case Op::white2:
      return for_each_vector(a, b, frequency, n, out,
                             [&](F x, F y) HWY_ATTR { return white2(x, y, seed); });
    case Op::white3:
      return for_each_vector(a, b, c, frequency, n, out,
                             [&](F x, F y, F z) HWY_ATTR { return white3(x, y, z, seed); });
    case Op::value2:
      return for_each_vector(a, b, frequency, n, out,
                             [&](F x, F y) HWY_ATTR { return value2(x, y, seed); });
    case Op::value3:
      return for_each_vector(a, b, c, frequency, n, out,
                             [&](F x, F y, F z) HWY_ATTR { return value3(x, y, z, seed); });
    case Op::value_cubic2:
      return for_each_vector(a, b, frequency, n, out,
                             [&](F x, F y) HWY_ATTR { return value_cubic2(x, y, seed); });
    case Op::value_cubic3:
      return for_each_vector(a, b, c, frequency, n, out,
                             [&](F x, F y, F z) HWY_ATTR { return value_cubic3(x, y, z, seed); });
    default:
      assert(false && "not a value noise");
  }
}

}  // namespace mc::graph::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
