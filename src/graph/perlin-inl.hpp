// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: Perlin noise without a permutation table.

#if defined(MC_GRAPH_PERLIN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_GRAPH_PERLIN_INL
#undef MC_GRAPH_PERLIN_INL
#else
#define MC_GRAPH_PERLIN_INL
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "graph/hash.hpp"
#include "graph/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::graph::HWY_NAMESPACE {

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

template <bool kNear>
HWY_INLINE F perlin3_at(F px, F py, F pz, W seed) {
  const Split x = split<kNear>(px);
  const Split y = split<kNear>(py);
  const Split z = split<kNear>(pz);
  const W x0 = x.cell * set(kPrimeX);
  const W y0 = seed ^ (y.cell * set(kPrimeY));
  const W y1 = seed ^ (y.cell * set(kPrimeY) + set(kPrimeY));
  const W z0 = z.cell * set(kPrimeZ);
  const W primed_x[2] = {x0, x0 + set(kPrimeX)};
  const W primed_yz[4] = {y0 ^ z0, y1 ^ z0, y0 ^ (z0 + set(kPrimeZ)), y1 ^ (z0 + set(kPrimeZ))};
  const F from_x[2] = {x.rest, x.rest - set(1.0F)};
  const F from_y[2] = {y.rest, y.rest - set(1.0F)};
  const F from_z[2] = {z.rest, z.rest - set(1.0F)};
  // Corner n is the far one along x, y, z where bit 0, 1, 2 of n is set.
  W hash[8];
  for (std::size_t n = 0; n < 8; ++n) hash[n] = primed_x[n & 1] ^ primed_yz[n >> 1];
  hash_all(hash);
  const F u = fade(x.rest);
  F edge[4];
  for (std::size_t n = 0; n < 4; ++n) {
    const F ey = from_y[n & 1];
    const F ez = from_z[n >> 1];
    edge[n] = lerp(u, gradient3(hash[2 * n], from_x[0], ey, ez),
                   gradient3(hash[2 * n + 1], from_x[1], ey, ez));
  }
  const F v = fade(y.rest);
  const F face = lerp(v, edge[0], edge[1]);
  return lerp(fade(z.rest), face, lerp(v, edge[2], edge[3])) * set(kPerlin3Scale);
}

HWY_INLINE F perlin3(F x, F y, F z, W seed) {
  return are_near(x, y, z) ? perlin3_at<true>(x, y, z, seed) : perlin3_at<false>(x, y, z, seed);
}

}  // namespace mc::graph::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
