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
namespace mc::graph::HWY_NAMESPACE {
namespace {

// The largest value of the raw noise, over all positions and gradients, scales to 1.
constexpr float kSimplex2Scale = 100.0401F;
constexpr float kSimplex3Scale = 76.88075F;
constexpr float kOpenSimplex2Scale = 99.41596F;
constexpr float kOpenSimplex3Scale = 76.88075F;  // simplex3's: the lattice is the same, but turned

/// (1/2 - r^2)^4, 0 outside.
HWY_INLINE F kernel(F r2) {
  const F t = greatest(set(0.5F) - r2, set(0.0F));
  return (t * t) * (t * t);
}

/// Sixteen unit gradients at odd multiples of 11.25 degrees.
HWY_INLINE F gradient16(W hash, F x, F y) {
  const W far = hn::ShiftLeft<3>(hash);  // from an axis
  const F main = chosen(far, set(0.831469612F), set(0.980785280F));
  const F side = chosen(far, set(0.555570233F), set(0.195090322F));
  const F u = chosen(hash, y, x);
  const F v = chosen(hash, x, y);
  return flipped<29>(u, hash) * main + flipped<30>(v, hash) * side;
}

/// Distances that are not numbers give NaN, also where the kernel would be 0.
template <bool kSixteen>
HWY_INLINE F corner2(W mixed, F x, F y) {
  const W hash = hash_of(mixed);
  return kernel(x * x + y * y) * (kSixteen ? gradient16(hash, x, y) : gradient2(hash, x, y));
}

HWY_INLINE F hashed_corner3(W hash, F x, F y, F z) {
  return kernel((x * x + y * y) + z * z) * gradient3(hash, x, y, z);
}

HWY_INLINE F corner3(W mixed, F x, F y, F z) { return hashed_corner3(hash_of(mixed), x, y, z); }

/// With perlin2's eight gradients, or with sixteen; not scaled.
template <bool kSixteen>
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
  const F n0 = corner2<kSixteen>(seed ^ hx ^ hy, x0, y0);
  const F n1 =
      corner2<kSixteen>(seed ^ hx1 ^ hy1, (x0 - i1) + set(kUnskew), (y0 - j1) + set(kUnskew));
  const F n2 = corner2<kSixteen>(seed ^ (hx + set(kPrimeX)) ^ (hy + set(kPrimeY)),
                                 (x0 - set(1.0F)) + set(2.0F * kUnskew),
                                 (y0 - set(1.0F)) + set(2.0F * kUnskew));
  return (n0 + n1) + n2;
}

/// Where a corner of a tetrahedron lies one further than the first.
struct Step {
  hn::Mask<Floats> on;
  HWY_INLINE F length() const { return hn::IfThenElseZero(on, set(1.0F)); }
  HWY_INLINE W of(W primed, std::uint32_t prime) const {
    return primed + as_words(hn::IfThenElseZero(on, as_floats(set(prime))));
  }
};

template <bool kNear>
HWY_INLINE F simplex3_at(F px, F py, F pz, W seed) {
  constexpr float kSkew = 0.333333333F;
  constexpr float kUnskew = 0.166666667F;
  const F x = kNear ? px : clamped(px, -0x1p28F, 0x1p28F);
  const F y = kNear ? py : clamped(py, -0x1p28F, 0x1p28F);
  const F z = kNear ? pz : clamped(pz, -0x1p28F, 0x1p28F);
  const F s = ((x + y) + z) * set(kSkew);
  const Cell i = cell_at<kNear>(x + s);
  const Cell j = cell_at<kNear>(y + s);
  const Cell k = cell_at<kNear>(z + s);
  const F t = ((i.floor + j.floor) + k.floor) * set(kUnskew);
  const F x0 = x - (i.floor - t);
  const F y0 = y - (j.floor - t);
  const F z0 = z - (k.floor - t);
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
  const W hx = i.number * set(kPrimeX);
  const W hy = j.number * set(kPrimeY);
  const W hz = k.number * set(kPrimeZ);
  const F u1 = set(kUnskew);
  const F u2 = set(2.0F * kUnskew);
  W hash[4] = {seed ^ hx ^ hy ^ hz,
               seed ^ i1.of(hx, kPrimeX) ^ j1.of(hy, kPrimeY) ^ k1.of(hz, kPrimeZ),
               seed ^ i2.of(hx, kPrimeX) ^ j2.of(hy, kPrimeY) ^ k2.of(hz, kPrimeZ),
               seed ^ (hx + set(kPrimeX)) ^ (hy + set(kPrimeY)) ^ (hz + set(kPrimeZ))};
  hash_all(hash);
  const F n0 = hashed_corner3(hash[0], x0, y0, z0);
  const F n1 = hashed_corner3(hash[1], (x0 - i1.length()) + u1, (y0 - j1.length()) + u1,
                              (z0 - k1.length()) + u1);
  const F n2 = hashed_corner3(hash[2], (x0 - i2.length()) + u2, (y0 - j2.length()) + u2,
                              (z0 - k2.length()) + u2);
  const F n3 = hashed_corner3(hash[3], x0 - set(0.5F), y0 - set(0.5F), z0 - set(0.5F));
  return (((n0 + n1) + n2) + n3) * set(kSimplex3Scale);
}

HWY_INLINE F simplex3(F x, F y, F z, W seed) {
  return are_near(x, y, z) ? simplex3_at<true>(x, y, z, seed) : simplex3_at<false>(x, y, z, seed);
}

/// What the two points of a cubic lattice that are nearest to (x, y, z) give. `mixed` are the seed
/// and the lattice's own number.
HWY_INLINE F cubic_pair(F px, F py, F pz, W mixed) {
  const auto nearest = [](F v) HWY_ATTR { return cell_of(v + set(0.5F)); };
  const I i = nearest(px);
  const I j = nearest(py);
  const I k = nearest(pz);
  const F x = px - hn::ConvertTo(Floats(), i);
  const F y = py - hn::ConvertTo(Floats(), j);
  const F z = pz - hn::ConvertTo(Floats(), k);
  const W hx = as_words(i) * set(kPrimeX);
  const W hy = as_words(j) * set(kPrimeY);
  const W hz = as_words(k) * set(kPrimeZ);
  // The second is a step away from the first along the axis on which the first is farthest.
  const auto on_x = hn::And(hn::Ge(hn::Abs(x), hn::Abs(y)), hn::Ge(hn::Abs(x), hn::Abs(z)));
  const auto on_y = hn::AndNot(on_x, hn::Ge(hn::Abs(y), hn::Abs(z)));
  const auto on_z = hn::Not(hn::Or(on_x, on_y));
  const auto beyond = [](hn::Mask<Floats> on, F v) HWY_ATTR {
    return v - hn::IfThenElseZero(on, hn::CopySign(set(1.0F), v));
  };
  const auto stepped = [](hn::Mask<Floats> on, F v, W primed, std::uint32_t prime) HWY_ATTR {
    const F step = chosen(as_words(v), as_floats(set(0U - prime)), as_floats(set(prime)));
    return primed + as_words(hn::IfThenElseZero(on, step));
  };
  const W second =
      stepped(on_x, x, hx, kPrimeX) ^ stepped(on_y, y, hy, kPrimeY) ^ stepped(on_z, z, hz, kPrimeZ);
  return corner3(mixed ^ hx ^ hy ^ hz, x, y, z) +
         corner3(mixed ^ second, beyond(on_x, x), beyond(on_y, y), beyond(on_z, z));
}

/// Two cubic lattices, half a cell apart, turned so that no axis of theirs lies along one of ours.
HWY_INLINE F open_simplex3(F px, F py, F pz, W seed) {
  const F x = clamped(px, -0x1p28F, 0x1p28F);
  const F y = clamped(py, -0x1p28F, 0x1p28F);
  const F z = clamped(pz, -0x1p28F, 0x1p28F);
  const F r = ((x + y) + z) * set(0.666666667F);
  const F half = set(0.5F);
  const F whole = cubic_pair(r - x, r - y, r - z, seed);
  const F between =
      cubic_pair((r - x) - half, (r - y) - half, (r - z) - half, seed ^ set(0x5BD1E995U));
  return (whole + between) * set(kOpenSimplex3Scale);
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
      return for_each_vector(a, b, frequency, n, out, [&](F x, F y) HWY_ATTR {
        return simplex2<false>(x, y, seed) * set(kSimplex2Scale);
      });
    case Op::simplex3:
      return for_each_vector(a, b, c, frequency, n, out,
                             [&](F x, F y, F z) HWY_ATTR { return simplex3(x, y, z, seed); });
    case Op::open_simplex2:
      return for_each_vector(a, b, frequency, n, out, [&](F x, F y) HWY_ATTR {
        return simplex2<true>(x, y, seed) * set(kOpenSimplex2Scale);
      });
    case Op::open_simplex3:
      return for_each_vector(a, b, c, frequency, n, out,
                             [&](F x, F y, F z) HWY_ATTR { return open_simplex3(x, y, z, seed); });
    case Op::unity2:
      return for_each_vector(a, b, frequency, n, out,
                             [](F x, F y) HWY_ATTR { return unity2(x, y); });
    default:
      assert(false && "not a gradient noise");
  }
}

}  // namespace mc::graph::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
