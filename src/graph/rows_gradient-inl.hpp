// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see rows.hpp for what the function does.

#if defined(MC_GRAPH_ROWS_GRADIENT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_GRAPH_ROWS_GRADIENT_INL
#undef MC_GRAPH_ROWS_GRADIENT_INL
#else
#define MC_GRAPH_ROWS_GRADIENT_INL
#endif

#include <hwy/highway.h>

#include <cassert>

#include "graph/hash.hpp"
#include "graph/lanes-inl.hpp"
#include "graph/perlin-inl.hpp"
#include "graph/perlin_run-inl.hpp"
#include "graph/permutation.hpp"
#include "graph/rows.hpp"

// Gradient noises without a permutation table, and Unity's, which has one. Every sample runs the
// same operations: gradients are chosen by selects.

HWY_BEFORE_NAMESPACE();
namespace mc::graph {
namespace HWY_NAMESPACE {
namespace {

// The largest value of the raw noise, over all positions and gradients, scales to 1.
constexpr float kSimplex2Scale = 100.0401F;
constexpr float kSimplex3Scale = 76.88075F;

/// (1/2 - r^2)^4, 0 outside.
HWY_INLINE F kernel(F r2) {
  const F t = greatest(set(0.5F) - r2, set(0.0F));
  return (t * t) * (t * t);
}

/// Distances that are not numbers give NaN, also where the kernel would be 0.
HWY_INLINE F corner2(W mixed, F x, F y) {
  return kernel(x * x + y * y) * gradient2(hash_of(mixed), x, y);
}

HWY_INLINE F corner3(W mixed, F x, F y, F z) {
  return kernel((x * x + y * y) + z * z) * gradient3(hash_of(mixed), x, y, z);
}

HWY_INLINE F simplex2(F px, F py, W seed) {
  constexpr float kSkew = 0.366025404F;    // (sqrt(3) - 1) / 2
  constexpr float kUnskew = 0.211324865F;  // (3 - sqrt(3)) / 6
  const F x = clamped(px, -0x1p28F, 0x1p28F);
  const F y = clamped(py, -0x1p28F, 0x1p28F);
  const F s = (x + y) * set(kSkew);
  const I i = cell_of(x + s);
  const I j = cell_of(y + s);
  const F fi = hn::ConvertTo(Floats(), i);
  const F fj = hn::ConvertTo(Floats(), j);
  const F t = (fi + fj) * set(kUnskew);
  const F x0 = x - (fi - t);
  const F y0 = y - (fj - t);
  const auto x_first = hn::Gt(x0, y0);
  const F i1 = hn::IfThenElseZero(x_first, set(1.0F));
  const F j1 = set(1.0F) - i1;
  const W hx = as_words(i) * set(kPrimeX);
  const W hy = as_words(j) * set(kPrimeY);
  const W hx1 = hx + as_words(hn::IfThenElseZero(x_first, as_floats(set(kPrimeX))));
  const W hy1 = hy + as_words(hn::IfThenZeroElse(x_first, as_floats(set(kPrimeY))));
  const F n0 = corner2(seed ^ hx ^ hy, x0, y0);
  const F n1 = corner2(seed ^ hx1 ^ hy1, (x0 - i1) + set(kUnskew), (y0 - j1) + set(kUnskew));
  const F n2 =
      corner2(seed ^ (hx + set(kPrimeX)) ^ (hy + set(kPrimeY)),
              (x0 - set(1.0F)) + set(2.0F * kUnskew), (y0 - set(1.0F)) + set(2.0F * kUnskew));
  return ((n0 + n1) + n2) * set(kSimplex2Scale);
}

/// Where a corner of a tetrahedron lies one further than the first.
struct Step {
  hn::Mask<Floats> on;
  HWY_INLINE F length() const { return hn::IfThenElseZero(on, set(1.0F)); }
  HWY_INLINE W of(W primed, std::uint32_t prime) const {
    return primed + as_words(hn::IfThenElseZero(on, as_floats(set(prime))));
  }
};

HWY_INLINE F simplex3(F px, F py, F pz, W seed) {
  constexpr float kSkew = 0.333333333F;
  constexpr float kUnskew = 0.166666667F;
  const F x = clamped(px, -0x1p28F, 0x1p28F);
  const F y = clamped(py, -0x1p28F, 0x1p28F);
  const F z = clamped(pz, -0x1p28F, 0x1p28F);
  const F s = ((x + y) + z) * set(kSkew);
  const I i = cell_of(x + s);
  const I j = cell_of(y + s);
  const I k = cell_of(z + s);
  const F fi = hn::ConvertTo(Floats(), i);
  const F fj = hn::ConvertTo(Floats(), j);
  const F fk = hn::ConvertTo(Floats(), k);
  const F t = ((fi + fj) + fk) * set(kUnskew);
  const F x0 = x - (fi - t);
  const F y0 = y - (fj - t);
  const F z0 = z - (fk - t);
  // The order of the coordinates says which of the cell's six tetrahedra this is.
  const auto xy = hn::Ge(x0, y0);
  const auto xz = hn::Ge(x0, z0);
  const auto yz = hn::Ge(y0, z0);
  const Step i1{hn::And(xy, xz)};
  const Step j1{hn::AndNot(xy, yz)};
  const Step k1{hn::Not(hn::Or(xz, yz))};
  const Step i2{hn::Or(xy, xz)};
  const Step j2{hn::Or(hn::Not(xy), yz)};
  const Step k2{hn::Not(hn::And(xz, yz))};
  const W hx = as_words(i) * set(kPrimeX);
  const W hy = as_words(j) * set(kPrimeY);
  const W hz = as_words(k) * set(kPrimeZ);
  const F u1 = set(kUnskew);
  const F u2 = set(2.0F * kUnskew);
  const F n0 = corner3(seed ^ hx ^ hy ^ hz, x0, y0, z0);
  const F n1 = corner3(seed ^ i1.of(hx, kPrimeX) ^ j1.of(hy, kPrimeY) ^ k1.of(hz, kPrimeZ),
                       (x0 - i1.length()) + u1, (y0 - j1.length()) + u1, (z0 - k1.length()) + u1);
  const F n2 = corner3(seed ^ i2.of(hx, kPrimeX) ^ j2.of(hy, kPrimeY) ^ k2.of(hz, kPrimeZ),
                       (x0 - i2.length()) + u2, (y0 - j2.length()) + u2, (z0 - k2.length()) + u2);
  const F n3 = corner3(seed ^ (hx + set(kPrimeX)) ^ (hy + set(kPrimeY)) ^ (hz + set(kPrimeZ)),
                       x0 - set(0.5F), y0 - set(0.5F), z0 - set(0.5F));
  return (((n0 + n1) + n2) + n3) * set(kSimplex3Scale);
}

/// table[v & 255].
HWY_INLINE W looked_up(const PermutationTable& table, W v) {
  const I index = hn::BitCast(Integers(), v & set(255U));
  return as_words(hn::GatherIndex(Integers(), table.data(), index));
}

/// The z = 0 slice of the three-dimensional gradients.
HWY_INLINE F unity_gradient(W place, F x, F y) {
  const W h = hn::ShiftLeft<28>(looked_up(kPermutedTwice, place));
  return gradient3(h, x, y, set(0.0F));
}

HWY_INLINE F unity2(F px, F py) {
  const Split x = split(hn::Abs(px));
  const Split y = split(hn::Abs(py));
  const F ax = x.rest;
  const F bx = ax - set(1.0F);
  const F ay = y.rest;
  const F by = ay - set(1.0F);
  const F u = fade(clamped(ax, 0.0F, 1.0F));
  const F v = fade(clamped(ay, 0.0F, 1.0F));
  const W a = looked_up(kPermuted, x.cell) + y.cell;
  const W b = looked_up(kPermuted, x.cell + set(1U)) + y.cell;
  const F near = lerp(u, unity_gradient(a, ax, ay), unity_gradient(b, bx, ay));
  const F far = lerp(u, unity_gradient(a + set(1U), ax, by), unity_gradient(b + set(1U), bx, by));
  return (lerp(v, near, far) + set(0.69F)) / set(1.483F);
}

}  // namespace

void gradient_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n, OutRow out) {
  const float frequency = instruction.p[0];
  const W seed = set(instruction.seed);
  switch (instruction.op) {
    case Op::perlin2:
      if (stays(b, n) && rises_slowly(a, frequency, n)) {
        return perlin2_run(a, b[0] * frequency, frequency, seed, n, out);
      }
      return for_each_vector(a, b, frequency, n, out,
                             [&](F x, F y) HWY_ATTR { return perlin2(x, y, seed); });
    case Op::perlin3:
      if (stays(b, n) && stays(c, n) && rises_slowly(a, frequency, n) &&
          !(is_whole(b[0] * frequency) && is_whole(c[0] * frequency))) {
        return perlin3_run(a, b[0] * frequency, c[0] * frequency, frequency, seed, n, out);
      }
      return for_each_vector(a, b, c, frequency, n, out,
                             [&](F x, F y, F z) HWY_ATTR { return perlin3(x, y, z, seed); });
    case Op::simplex2:
      return for_each_vector(a, b, frequency, n, out,
                             [&](F x, F y) HWY_ATTR { return simplex2(x, y, seed); });
    case Op::simplex3:
      return for_each_vector(a, b, c, frequency, n, out,
                             [&](F x, F y, F z) HWY_ATTR { return simplex3(x, y, z, seed); });
    case Op::unity2:
      return for_each_vector(a, b, frequency, n, out,
                             [](F x, F y) HWY_ATTR { return unity2(x, y); });
    default:
      assert(false && "not a gradient noise");
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace mc::graph
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
