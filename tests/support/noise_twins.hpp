// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "graph/float_math.hpp"
#include "graph/hash.hpp"
#include "graph/permutation.hpp"

// The noises of src/graph, a sample at a time in plain C++: what their kernels are compared with.

namespace mc::tests::twin {

using namespace mc::graph;  // float_math.hpp and hash.hpp, which both share

// The largest value of the raw noise, over all positions and gradients, scales to 1.
inline constexpr float kPerlin2Scale = 1.5132795F;
inline constexpr float kPerlin3Scale = 0.96492142F;
inline constexpr float kSimplex2Scale = 100.0401F;
inline constexpr float kSimplex3Scale = 76.88075F;

/// A coordinate split into its cell and the rest. Beyond 2^30 cells it is held there; for NaN the
/// cell is the lowest and the rest NaN.
struct Split {
  std::uint32_t cell;
  float rest;
};

/// Floor of |v| <= 2^30, in 32-bit integers.
inline std::int32_t cell_of(float v) noexcept {
  const float safe = v >= -0x1p30F ? v : -0x1p30F;  // NaN too
  const auto cut = static_cast<std::int32_t>(safe);
  return static_cast<float>(cut) > safe ? cut - 1 : cut;
}

inline Split split(float v) noexcept {
  const float held = clamped(v, -0x1p30F, 0x1p30F);
  const std::int32_t cell = cell_of(held);
  return {static_cast<std::uint32_t>(cell), held - static_cast<float>(cell)};
}

inline float fade(float t) noexcept { return (((6.0F * t - 15.0F) * t) + 10.0F) * ((t * t) * t); }

inline float lerp(float t, float a, float b) noexcept { return a + t * (b - a); }

/// v, or -v where the bit (its number) of h is set.
inline float flipped(float v, std::uint32_t h, unsigned bit) noexcept {
  const std::uint32_t sign = (h << (31U - bit)) & 0x80000000U;
  return std::bit_cast<float>(std::bit_cast<std::uint32_t>(v) ^ sign);
}

/// Eight unit gradients at odd multiples of 22.5 degrees, none along an axis.
inline float gradient2(std::uint32_t hash, float x, float y) noexcept {
  const std::uint32_t h = hash >> 29;
  const float u = (h & 4U) != 0 ? y : x;
  const float v = (h & 4U) != 0 ? x : y;
  return flipped(u, h, 0) * 0.923879533F + flipped(v, h, 1) * 0.382683432F;
}

/// The twelve edge directions of a cube, four of them twice.
inline float gradient3(std::uint32_t hash, float x, float y, float z) noexcept {
  const std::uint32_t h = hash >> 28;
  const float u = h < 8 ? x : y;
  const float x_or_z = (h & 13U) == 12U ? x : z;  // 12 and 14
  const float v = h < 4 ? y : x_or_z;
  return flipped(u, h, 0) + flipped(v, h, 1);
}

inline float perlin2(float px, float py, std::uint32_t seed) noexcept {
  const Split x = split(px);
  const Split y = split(py);
  const std::uint32_t x0 = x.cell * kPrimeX;
  const std::uint32_t x1 = x0 + kPrimeX;
  const std::uint32_t y0 = y.cell * kPrimeY;
  const std::uint32_t y1 = y0 + kPrimeY;
  const float u = fade(x.rest);
  const float v = fade(y.rest);
  const float n00 = gradient2(hash_point(seed, x0, y0, 0), x.rest, y.rest);
  const float n10 = gradient2(hash_point(seed, x1, y0, 0), x.rest - 1.0F, y.rest);
  const float n01 = gradient2(hash_point(seed, x0, y1, 0), x.rest, y.rest - 1.0F);
  const float n11 = gradient2(hash_point(seed, x1, y1, 0), x.rest - 1.0F, y.rest - 1.0F);
  return lerp(v, lerp(u, n00, n10), lerp(u, n01, n11)) * kPerlin2Scale;
}

inline float perlin3(float px, float py, float pz, std::uint32_t seed) noexcept {
  const Split x = split(px);
  const Split y = split(py);
  const Split z = split(pz);
  const std::uint32_t x0 = x.cell * kPrimeX;
  const std::uint32_t x1 = x0 + kPrimeX;
  const std::uint32_t y0 = y.cell * kPrimeY;
  const std::uint32_t y1 = y0 + kPrimeY;
  const std::uint32_t z0 = z.cell * kPrimeZ;
  const std::uint32_t z1 = z0 + kPrimeZ;
  const float ax = x.rest;
  const float bx = ax - 1.0F;
  const float ay = y.rest;
  const float by = ay - 1.0F;
  const float az = z.rest;
  const float bz = az - 1.0F;
  const float u = fade(ax);
  const float v = fade(ay);
  const float w = fade(az);
  const float n000 = gradient3(hash_point(seed, x0, y0, z0), ax, ay, az);
  const float n100 = gradient3(hash_point(seed, x1, y0, z0), bx, ay, az);
  const float n010 = gradient3(hash_point(seed, x0, y1, z0), ax, by, az);
  const float n110 = gradient3(hash_point(seed, x1, y1, z0), bx, by, az);
  const float n001 = gradient3(hash_point(seed, x0, y0, z1), ax, ay, bz);
  const float n101 = gradient3(hash_point(seed, x1, y0, z1), bx, ay, bz);
  const float n011 = gradient3(hash_point(seed, x0, y1, z1), ax, by, bz);
  const float n111 = gradient3(hash_point(seed, x1, y1, z1), bx, by, bz);
  const float near = lerp(v, lerp(u, n000, n100), lerp(u, n010, n110));
  const float far = lerp(v, lerp(u, n001, n101), lerp(u, n011, n111));
  return lerp(w, near, far) * kPerlin3Scale;
}

/// (1/2 - r^2)^4, 0 outside.
inline float kernel(float r2) noexcept {
  const float t = greatest(0.5F - r2, 0.0F);
  return (t * t) * (t * t);
}

/// Distances that are not numbers give NaN, also where the kernel would be 0.
using Gradient2 = float (*)(std::uint32_t, float, float) noexcept;

inline float corner2(Gradient2 gradient, std::uint32_t hash, float x, float y) noexcept {
  return kernel(x * x + y * y) * gradient(hash, x, y);
}

inline float corner3(std::uint32_t hash, float x, float y, float z) noexcept {
  return kernel((x * x + y * y) + z * z) * gradient3(hash, x, y, z);
}

/// Not scaled.
inline float simplex2(Gradient2 gradient, float px, float py, std::uint32_t seed) noexcept {
  constexpr float kSkew = 0.366025404F;    // (sqrt(3) - 1) / 2
  constexpr float kUnskew = 0.211324865F;  // (3 - sqrt(3)) / 6
  const float x = clamped(px, -0x1p28F, 0x1p28F);
  const float y = clamped(py, -0x1p28F, 0x1p28F);
  const float s = (x + y) * kSkew;
  const std::int32_t i = cell_of(x + s);
  const std::int32_t j = cell_of(y + s);
  const float fi = static_cast<float>(i);
  const float fj = static_cast<float>(j);
  const float t = (fi + fj) * kUnskew;
  const float x0 = x - (fi - t);
  const float y0 = y - (fj - t);
  const bool x_first = x0 > y0;
  const float i1 = x_first ? 1.0F : 0.0F;
  const float j1 = 1.0F - i1;
  const std::uint32_t hx = static_cast<std::uint32_t>(i) * kPrimeX;
  const std::uint32_t hy = static_cast<std::uint32_t>(j) * kPrimeY;
  const std::uint32_t hx1 = hx + (x_first ? kPrimeX : 0U);
  const std::uint32_t hy1 = hy + (x_first ? 0U : kPrimeY);
  const float n0 = corner2(gradient, hash_point(seed, hx, hy, 0), x0, y0);
  const float n1 =
      corner2(gradient, hash_point(seed, hx1, hy1, 0), (x0 - i1) + kUnskew, (y0 - j1) + kUnskew);
  const float n2 = corner2(gradient, hash_point(seed, hx + kPrimeX, hy + kPrimeY, 0),
                           (x0 - 1.0F) + 2.0F * kUnskew, (y0 - 1.0F) + 2.0F * kUnskew);
  return (n0 + n1) + n2;
}

inline float simplex2(float px, float py, std::uint32_t seed) noexcept {
  return simplex2(gradient2, px, py, seed) * kSimplex2Scale;
}

/// Sixteen unit gradients at odd multiples of 11.25 degrees.
inline float gradient16(std::uint32_t hash, float x, float y) noexcept {
  const std::uint32_t h = hash >> 28;
  const float main = (h & 1U) != 0 ? 0.831469612F : 0.980785280F;
  const float side = (h & 1U) != 0 ? 0.555570233F : 0.195090322F;
  const float u = (h & 8U) != 0 ? y : x;
  const float v = (h & 8U) != 0 ? x : y;
  return flipped(u, h, 1) * main + flipped(v, h, 2) * side;
}

inline float open_simplex2(float px, float py, std::uint32_t seed) noexcept {
  return simplex2(gradient16, px, py, seed) * 99.41596F;
}

inline float simplex3(float px, float py, float pz, std::uint32_t seed) noexcept {
  constexpr float kSkew = 0.333333333F;
  constexpr float kUnskew = 0.166666667F;
  const float x = clamped(px, -0x1p28F, 0x1p28F);
  const float y = clamped(py, -0x1p28F, 0x1p28F);
  const float z = clamped(pz, -0x1p28F, 0x1p28F);
  const float s = ((x + y) + z) * kSkew;
  const std::int32_t i = cell_of(x + s);
  const std::int32_t j = cell_of(y + s);
  const std::int32_t k = cell_of(z + s);
  const float fi = static_cast<float>(i);
  const float fj = static_cast<float>(j);
  const float fk = static_cast<float>(k);
  const float t = ((fi + fj) + fk) * kUnskew;
  const float x0 = x - (fi - t);
  const float y0 = y - (fj - t);
  const float z0 = z - (fk - t);
  // The order of the coordinates says which of the cell's six tetrahedra this is.
  const bool xy = x0 >= y0;
  const bool xz = x0 >= z0;
  const bool yz = y0 >= z0;
  const bool i1 = xy & xz;
  const bool j1 = !xy & yz;
  const bool k1 = !xz & !yz;
  const bool i2 = xy | xz;
  const bool j2 = !xy | yz;
  const bool k2 = !xz | !yz;
  const auto offset = [](bool on) { return on ? 1.0F : 0.0F; };
  const std::uint32_t hx = static_cast<std::uint32_t>(i) * kPrimeX;
  const std::uint32_t hy = static_cast<std::uint32_t>(j) * kPrimeY;
  const std::uint32_t hz = static_cast<std::uint32_t>(k) * kPrimeZ;
  const float n0 = corner3(hash_point(seed, hx, hy, hz), x0, y0, z0);
  const float n1 = corner3(hash_point(seed, hx + (i1 ? kPrimeX : 0U), hy + (j1 ? kPrimeY : 0U),
                                      hz + (k1 ? kPrimeZ : 0U)),
                           (x0 - offset(i1)) + kUnskew, (y0 - offset(j1)) + kUnskew,
                           (z0 - offset(k1)) + kUnskew);
  const float n2 = corner3(hash_point(seed, hx + (i2 ? kPrimeX : 0U), hy + (j2 ? kPrimeY : 0U),
                                      hz + (k2 ? kPrimeZ : 0U)),
                           (x0 - offset(i2)) + 2.0F * kUnskew, (y0 - offset(j2)) + 2.0F * kUnskew,
                           (z0 - offset(k2)) + 2.0F * kUnskew);
  const float n3 = corner3(hash_point(seed, hx + kPrimeX, hy + kPrimeY, hz + kPrimeZ), x0 - 0.5F,
                           y0 - 0.5F, z0 - 0.5F);
  return (((n0 + n1) + n2) + n3) * kSimplex3Scale;
}

inline float cubic_pair(const float (&p)[3], std::uint32_t seed) noexcept {
  constexpr std::uint32_t kPrimes[3] = {kPrimeX, kPrimeY, kPrimeZ};
  std::uint32_t h[3];
  float d[3];
  for (int n = 0; n < 3; ++n) {
    const std::int32_t cell = cell_of(p[n] + 0.5F);
    h[n] = static_cast<std::uint32_t>(cell) * kPrimes[n];
    d[n] = p[n] - static_cast<float>(cell);
  }
  const float first = corner3(hash_point(seed, h[0], h[1], h[2]), d[0], d[1], d[2]);
  const float x = std::abs(d[0]);
  const float y = std::abs(d[1]);
  const float z = std::abs(d[2]);
  const int axis = x >= y && x >= z ? 0 : (y >= z ? 1 : 2);
  const bool down = std::signbit(d[axis]);
  h[axis] += down ? 0U - kPrimes[axis] : kPrimes[axis];
  d[axis] -= down ? -1.0F : 1.0F;
  return first + corner3(hash_point(seed, h[0], h[1], h[2]), d[0], d[1], d[2]);
}

inline float open_simplex3(float px, float py, float pz, std::uint32_t seed) noexcept {
  const float x = clamped(px, -0x1p28F, 0x1p28F);
  const float y = clamped(py, -0x1p28F, 0x1p28F);
  const float z = clamped(pz, -0x1p28F, 0x1p28F);
  const float r = ((x + y) + z) * 0.666666667F;
  const float whole = cubic_pair({r - x, r - y, r - z}, seed);
  const float half =
      cubic_pair({(r - x) - 0.5F, (r - y) - 0.5F, (r - z) - 0.5F}, seed ^ 0x5BD1E995U);
  return (whole + half) * 76.88075F;
}

inline std::uint32_t permuted(std::uint32_t v) noexcept {
  return static_cast<std::uint32_t>(kPermuted[v & 255U]);
}

/// The z = 0 slice of the three-dimensional gradients.
inline float unity_gradient(std::uint32_t hash, float x, float y) noexcept {
  const std::uint32_t h = hash & 15U;
  const float u = h < 8 ? x : y;
  const float x_or_zero = (h & 13U) == 12U ? x : 0.0F;
  const float v = h < 4 ? y : x_or_zero;
  return flipped(u, h, 0) + flipped(v, h, 1);
}

inline float unity2(float px, float py) noexcept {
  const Split x = split(std::abs(px));
  const Split y = split(std::abs(py));
  const float u = fade(clamped(x.rest, 0.0F, 1.0F));
  const float v = fade(clamped(y.rest, 0.0F, 1.0F));
  const std::uint32_t a = permuted(x.cell) + y.cell;
  const std::uint32_t b = permuted(x.cell + 1U) + y.cell;
  const float n00 = unity_gradient(permuted(permuted(a)), x.rest, y.rest);
  const float n10 = unity_gradient(permuted(permuted(b)), x.rest - 1.0F, y.rest);
  const float n01 = unity_gradient(permuted(permuted(a + 1U)), x.rest, y.rest - 1.0F);
  const float n11 = unity_gradient(permuted(permuted(b + 1U)), x.rest - 1.0F, y.rest - 1.0F);
  const float n = lerp(v, lerp(u, n00, n10), lerp(u, n01, n11));
  return (n + 0.69F) / 1.483F;
}

}  // namespace mc::tests::twin
