// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see vertex_kernels.hpp for what the functions do.

#if defined(MC_EXTRACT_CUBES_VERTEX_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_EXTRACT_CUBES_VERTEX_KERNELS_INL
#undef MC_EXTRACT_CUBES_VERTEX_KERNELS_INL
#else
#define MC_EXTRACT_CUBES_VERTEX_KERNELS_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <type_traits>

#include "extract/cubes/vertex_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::extraction::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class R>
void cut(const EdgeRule<R>& rule, const R* a, const R* b, std::size_t n, R* out) {
  if (rule.midpoint) {
    std::fill_n(out, n, R{0.5});
    return;
  }
  const hn::ScalableTag<R> d;
  const auto iso = hn::Set(d, rule.iso);
  const auto low = hn::Set(d, rule.low);
  const auto high = hn::Set(d, rule.high);
  const auto cutoff = hn::Set(d, rule.cutoff);
  const auto half = hn::Set(d, R{0.5});
  for (std::size_t e = 0; e < n; e += hn::Lanes(d)) {
    const auto from = hn::LoadU(d, a + e);
    const auto difference = hn::Sub(hn::LoadU(d, b + e), from);
    auto t = hn::Div(hn::Sub(iso, from), difference);
    t = hn::IfThenElse(hn::And(hn::IsFinite(t), hn::IsFinite(difference)), t, half);
    t = hn::IfThenElse(hn::Lt(t, low), low, t);
    t = hn::IfThenElse(hn::Gt(t, high), high, t);
    t = hn::IfThenElse(hn::Lt(hn::Abs(difference), cutoff), half, t);
    hn::StoreU(t, d, out + e);
  }
}

using Reals = hn::CappedTag<double, kEdgesAtOnce>;
using RealVector = hn::Vec<Reals>;

template <class R>
RealVector load_real(const R* from) {
  const Reals d;
  if constexpr (std::is_same_v<R, double>) {
    return hn::LoadU(d, from);
  } else {
    return hn::PromoteTo(d, hn::LoadU(hn::Rebind<R, Reals>(), from));
  }
}

/// Rounded to what is stored.
template <class P>
auto rounded(RealVector v) {
  if constexpr (std::is_same_v<P, double>) {
    return v;
  } else {
    return hn::DemoteTo(hn::Rebind<P, Reals>(), v);
  }
}

struct Matrix {
  RealVector m[3][3];

  /// Reads rows `stride` numbers apart.
  Matrix(const double* from, std::size_t stride) {
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) {
        m[r][c] = hn::Set(Reals(), from[r * stride + c]);
      }
    }
  }
  [[nodiscard]] RealVector row(std::size_t r, RealVector x, RealVector y, RealVector z) const {
    return hn::Add(hn::Add(hn::Mul(m[r][0], x), hn::Mul(m[r][1], y)), hn::Mul(m[r][2], z));
  }
};

/// The box of what was written.
template <class P>
class BoundsGatherer {
 public:
  using D = hn::Rebind<P, Reals>;
  using V = hn::Vec<D>;

  explicit BoundsGatherer(const Bounds& bounds) {
    for (std::size_t a = 0; a < 3; ++a) {
      lo_[a] = hn::Set(D(), static_cast<P>(bounds.lo[a]));
      hi_[a] = hn::Set(D(), static_cast<P>(bounds.hi[a]));
    }
  }
  void include(std::size_t a, V v) {
    lo_[a] = hn::Min(lo_[a], v);
    hi_[a] = hn::Max(hi_[a], v);
  }
  [[nodiscard]] Bounds bounds() const {
    const D d;
    Bounds out;
    for (std::size_t a = 0; a < 3; ++a) {
      // Zeros of both signs compare equal; adding one makes the result the same on every target.
      out.lo[a] = static_cast<double>(hn::GetLane(hn::MinOfLanes(d, lo_[a]))) + 0.0;
      out.hi[a] = static_cast<double>(hn::GetLane(hn::MaxOfLanes(d, hi_[a]))) + 0.0;
    }
    return out;
  }

 private:
  V lo_[3], hi_[3];
};

template <class R, class P>
void place(const EdgePlaces& edges, const R* t, const Affine& map, P* out, Bounds& bounds) {
  const Reals d;
  const hn::Rebind<P, Reals> stored;
  const Matrix linear(map.m.data(), 4);
  const RealVector shift[3] = {hn::Set(d, map.m[3]), hn::Set(d, map.m[7]), hn::Set(d, map.m[11])};
  const RealVector one = hn::Set(d, 1.0);
  BoundsGatherer<P> gatherer(bounds);
  for (std::size_t e = 0; e < edges.n; e += hn::Lanes(d)) {
    const RealVector along = load_real(t + e);
    const RealVector axis = load_real(edges.axis + e);
    const auto is_i = hn::Lt(axis, one);
    const auto is_k = hn::Gt(axis, one);
    const auto is_j = hn::Eq(axis, one);
    const RealVector x = hn::Add(load_real(edges.i + e), hn::IfThenElseZero(is_i, along));
    const RealVector y = hn::Add(load_real(edges.j + e), hn::IfThenElseZero(is_j, along));
    const RealVector z = hn::Add(load_real(edges.k + e), hn::IfThenElseZero(is_k, along));
    const auto px = rounded<P>(hn::Add(linear.row(0, x, y, z), shift[0]));
    const auto py = rounded<P>(hn::Add(linear.row(1, x, y, z), shift[1]));
    const auto pz = rounded<P>(hn::Add(linear.row(2, x, y, z), shift[2]));
    gatherer.include(0, px);
    gatherer.include(1, py);
    gatherer.include(2, pz);
    hn::StoreInterleaved3(px, py, pz, stored, out + 3 * e);
  }
  bounds = gatherer.bounds();
}

template <class R>
std::size_t orient(const EdgeGradients<R>& g, const R* t, std::size_t n,
                   const std::array<double, 9>& turn, float* out, std::uint32_t* failed) {
  const Reals d;
  const hn::Rebind<float, Reals> stored;
  const hn::Rebind<R, Reals> given;
  const Matrix turned(turn.data(), 3);
  const RealVector shortest = hn::Set(d, kShortestSquare);
  const RealVector longest = hn::Set(d, kLongestSquare);
  const RealVector one = hn::Set(d, 1.0);
  std::size_t n_failed = 0;
  for (std::size_t e = 0; e < n; e += hn::Lanes(d)) {
    const auto along = hn::LoadU(given, t + e);
    RealVector at[3];
    for (std::size_t a = 0; a < 3; ++a) {
      const auto lower = hn::LoadU(given, g.lower[a] + e);
      const auto upper = hn::LoadU(given, g.upper[a] + e);
      const auto between = hn::Add(lower, hn::Mul(along, hn::Sub(upper, lower)));
      if constexpr (std::is_same_v<R, double>) {
        at[a] = between;
      } else {
        at[a] = hn::PromoteTo(d, between);
      }
    }
    const RealVector x = turned.row(0, at[0], at[1], at[2]);
    const RealVector y = turned.row(1, at[0], at[1], at[2]);
    const RealVector z = turned.row(2, at[0], at[1], at[2]);
    const RealVector square = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
    const RealVector inverse = hn::Div(one, hn::Sqrt(square));
    hn::StoreInterleaved3(rounded<float>(hn::Mul(x, inverse)), rounded<float>(hn::Mul(y, inverse)),
                          rounded<float>(hn::Mul(z, inverse)), stored, out + 3 * e);
    const auto good = hn::And(hn::Ge(square, shortest), hn::Le(square, longest));
    std::uint64_t bad = 0;
    hn::StoreMaskBits(d, hn::Not(good), reinterpret_cast<std::uint8_t*>(&bad));
    for (; bad != 0; bad &= bad - 1) {
      const std::size_t edge = e + static_cast<std::size_t>(std::countr_zero(bad));
      if (edge < n) {
        failed[n_failed++] = static_cast<std::uint32_t>(edge);
      }
    }
  }
  return n_failed;
}

void cut_f32(const EdgeRule<float>& rule, const float* a, const float* b, std::size_t n, float* t) {
  cut(rule, a, b, n, t);
}
void cut_f64(const EdgeRule<double>& rule, const double* a, const double* b, std::size_t n,
             double* t) {
  cut(rule, a, b, n, t);
}
void place_f32_f32(const EdgePlaces& e, const float* t, const Affine& m, float* out, Bounds& b) {
  place(e, t, m, out, b);
}
void place_f32_f64(const EdgePlaces& e, const float* t, const Affine& m, double* out, Bounds& b) {
  place(e, t, m, out, b);
}
void place_f64_f32(const EdgePlaces& e, const double* t, const Affine& m, float* out, Bounds& b) {
  place(e, t, m, out, b);
}
void place_f64_f64(const EdgePlaces& e, const double* t, const Affine& m, double* out, Bounds& b) {
  place(e, t, m, out, b);
}
std::size_t orient_f32(const EdgeGradients<float>& g, const float* t, std::size_t n,
                       const std::array<double, 9>& turn, float* out, std::uint32_t* failed) {
  return orient(g, t, n, turn, out, failed);
}
std::size_t orient_f64(const EdgeGradients<double>& g, const double* t, std::size_t n,
                       const std::array<double, 9>& turn, float* out, std::uint32_t* failed) {
  return orient(g, t, n, turn, out, failed);
}

}  // namespace mc::extraction::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
