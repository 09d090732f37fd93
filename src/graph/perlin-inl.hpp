// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: Perlin noise without a permutation table.

#if defined(MC_GRAPH_PERLIN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_GRAPH_PERLIN_INL
#undef MC_GRAPH_PERLIN_INL
#else
#define MC_GRAPH_PERLIN_INL
#endif

#include <hwy/highway.h>

#include "graph/hash.hpp"
#include "graph/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::graph {
namespace HWY_NAMESPACE {

// The largest value of the raw noise, over all positions and gradients, scales to 1.
constexpr float kPerlin2Scale = 1.5132795F;
constexpr float kPerlin3Scale = 0.96492142F;

HWY_INLINE F perlin2(F px, F py, W seed) {
  const Split x = split(px);
  const Split y = split(py);
  const W x0 = x.cell * set(kPrimeX);
  const W x1 = x0 + set(kPrimeX);
  const W y0 = seed ^ (y.cell * set(kPrimeY));
  const W y1 = seed ^ (y.cell * set(kPrimeY) + set(kPrimeY));
  const F ax = x.rest;
  const F bx = ax - set(1.0F);
  const F ay = y.rest;
  const F by = ay - set(1.0F);
  const F u = fade(ax);
  const F near = lerp(u, gradient2(hash_of(x0 ^ y0), ax, ay), gradient2(hash_of(x1 ^ y0), bx, ay));
  const F far = lerp(u, gradient2(hash_of(x0 ^ y1), ax, by), gradient2(hash_of(x1 ^ y1), bx, by));
  return lerp(fade(ay), near, far) * set(kPerlin2Scale);
}

/// The cell's edge along x: both gradients there, blended.
struct EdgeAlongX {
  W x0, x1;  // the ends' primed cells
  F ax, bx;  // the sample as seen from them
  F blend;
  HWY_INLINE F at(W yz, F y, F z) const {
    return lerp(blend, gradient3(hash_of(x0 ^ yz), ax, y, z),
                gradient3(hash_of(x1 ^ yz), bx, y, z));
  }
};

HWY_INLINE F perlin3(F px, F py, F pz, W seed) {
  const Split x = split(px);
  const Split y = split(py);
  const Split z = split(pz);
  const W x0 = x.cell * set(kPrimeX);
  const W y0 = seed ^ (y.cell * set(kPrimeY));
  const W y1 = seed ^ (y.cell * set(kPrimeY) + set(kPrimeY));
  const W z0 = z.cell * set(kPrimeZ);
  const W z1 = z0 + set(kPrimeZ);
  const F ay = y.rest;
  const F by = ay - set(1.0F);
  const F az = z.rest;
  const F bz = az - set(1.0F);
  const EdgeAlongX edge{x0, x0 + set(kPrimeX), x.rest, x.rest - set(1.0F), fade(x.rest)};
  const F v = fade(ay);
  const F near = lerp(v, edge.at(y0 ^ z0, ay, az), edge.at(y1 ^ z0, by, az));
  const F far = lerp(v, edge.at(y0 ^ z1, ay, bz), edge.at(y1 ^ z1, by, bz));
  return lerp(fade(az), near, far) * set(kPerlin3Scale);
}

}  // namespace HWY_NAMESPACE
}  // namespace mc::graph
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
