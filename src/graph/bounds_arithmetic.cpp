// SPDX-License-Identifier: MIT
#include "graph/bounds_arithmetic.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "graph/float_math.hpp"

namespace mc::graph {

Interval fraction(Interval a) {
  const float cell = exact_floor(a.lo);
  if (cell != exact_floor(a.hi)) return between(0, 1);  // 1 by rounding, just below an integer
  return between(a.lo - cell, a.hi - cell);
}

/// exact_sin is within 2e-7 of the sine up to 8192.
Interval sine(Interval a) {
  constexpr double kPi = 3.14159265358979323846;
  constexpr float kError = 1e-6F;
  if (size_of(a) > 8192 || double{a.hi} - double{a.lo} >= 2 * kPi) return between(-1, 1);
  const double from = double{a.lo} / kPi - 0.5;  // extremes are at integers
  const double to = double{a.hi} / kPi - 0.5;
  Interval out = widened(hull(exact_sin(a.lo), exact_sin(a.hi)), kError);
  const auto last = static_cast<std::int32_t>(std::floor(to + 1e-6));
  for (auto n = static_cast<std::int32_t>(std::ceil(from - 1e-6)); n <= last; ++n) {
    (n % 2 == 0 ? out.hi : out.lo) = n % 2 == 0 ? 1.0F : -1.0F;
  }
  return between(std::max(out.lo, -1.0F), std::min(out.hi, 1.0F));
}

namespace {

/// exact_pow of a base that is not negative: |b log2 a| is largest at a corner, and so is the
/// relative error of 2e-7 of each unit of it. Bases below 2^-126 count as zero, and so do results.
Interval power_of_positive(Interval a, Interval b) {
  constexpr float kLeast = 0x1p-120F;
  if (a.lo < kLeast && !(b.lo > 0)) return kUnknown;
  const auto exponent = [](float u, float v) { return v * exact_log2(greatest(u, kLeast)); };
  const Interval e = over_corners(a, b, exponent);
  if (!(e.hi < 120)) return kUnknown;
  const bool vanishes = a.lo < kLeast || e.lo < -100;
  const float slack = 1e-6F * (1 + size_of(e));
  return between(vanishes ? 0 : exact_exp2(e.lo) * (1 - slack),
                 exact_exp2(std::max(e.hi, -100.0F)) * (1 + slack));
}

}  // namespace

Interval power(Interval a, Interval b) {
  if (a.lo >= 0) return power_of_positive(a, b);
  const bool whole = b.single() && exact_floor(b.lo) == b.lo && b.lo > 0;
  if (!whole) return kUnknown;
  const Interval size = power_of_positive(magnitude(a), b);
  if (std::fmod(b.lo, 2.0F) == 0) return size;
  return a.hi <= 0 ? between(-size.hi, -size.lo) : between(-size.hi, size.hi);
}

/// a - b floor(a / b), with a divisor of one sign.
Interval remainder(Interval a, Interval b) {
  if (holds_zero(b)) return kUnknown;
  const Interval turns = quotient(a, b);
  if (!turns.known()) return kUnknown;
  const float turn = exact_floor(turns.lo);
  if (b.single() && turn == exact_floor(turns.hi)) {
    return between(a.lo - b.lo * turn, a.hi - b.lo * turn);
  }
  // A quotient rounded to an integer, and what the product and the difference lose.
  const float slack = (size_of(a) + size_of(b)) * 0x1p-20F;
  return b.lo > 0 ? between(-slack, b.hi + slack) : between(b.lo - slack, slack);
}

Interval smooth_step(Interval a, float edge, float width) {
  const Interval t = monotone(a, [&](float v) { return clamped((v - edge) / width, 0.0F, 1.0F); });
  const auto s = [](float v) { return (v * v) * (3.0F - 2.0F * v); };
  if (!t.known() || width == 0) return kUnknown;
  if (t.single()) return between(s(t.lo), s(t.lo));
  return between(s(t.lo) * (1 - 0x1p-20F), s(t.hi) * (1 + 0x1p-20F));
}

/// a + (b - a) c: also between a and b, but for rounding, where c is a fraction.
Interval mixture(Interval a, Interval b, Interval c) {
  const Interval plain = sum(a, product(difference(b, a), c));
  if (!(c.lo >= 0 && c.hi <= 1)) return plain;
  const float slack = std::max(size_of(a), size_of(b)) * 0x1p-20F;
  const Interval both = widened({std::min(a.lo, b.lo), std::max(a.hi, b.hi)}, slack);
  return plain.known() ? between(std::max(plain.lo, both.lo), std::min(plain.hi, both.hi)) : plain;
}

/// A select's band, of its ends the sides themselves.
Interval blended(Interval a, Interval b, Interval t) {
  if (!t.known()) return kUnknown;
  if (t.hi <= 0) return a;
  if (t.lo >= 1) return b;
  Interval out = mixture(a, b, {std::max(t.lo, 0.0F), std::min(t.hi, 1.0F)});
  if (t.lo <= 0) out = joined(out, a);
  return t.hi >= 1 ? joined(out, b) : out;
}

/// The cubic of a curve for places above its start. It is monotone on its own piece, but for the
/// rounding of its coefficients and steps, and held beyond it.
Interval curve_piece(Interval a, const std::array<float, 6>& p) {
  const auto at = [&](float v) { return least(greatest(v - p[0], 0.0F), p[5]); };
  const auto cubic = [&](float t) { return ((p[4] * t + p[3]) * t + p[2]) * t + p[1]; };
  const float t = at(a.hi);
  const float size = ((std::abs(p[4]) * t + std::abs(p[3])) * t + std::abs(p[2])) * t;
  return widened(hull(cubic(at(a.lo)), cubic(t)), (size + std::abs(p[1])) * 0x1p-20F);
}

/// Within one copy a shift; over several half a period each way, and what lies beyond the last.
Interval repetition(Interval a, const std::array<float, 6>& p) {
  const auto copy = [&](float v) { return clamped(exact_floor(v / p[0] + 0.5F), p[1], p[2]); };
  const auto place = [&](float v) { return v - p[0] * copy(v); };
  const Interval ends = hull(place(a.lo), place(a.hi));
  if (copy(a.lo) == copy(a.hi)) return ends;
  const float slack = (size_of(a) + p[0]) * 0x1p-20F;
  return joined(ends, widened({-0.5F * p[0], 0.5F * p[0]}, slack));
}

Interval weight(Interval amplitude, Interval noise, float gain, float weighted) {
  const Interval factor = monotone(noise, [&](float v) {
    const float level = clamped((v + 1.0F) * 0.5F, 0.0F, 1.0F);
    return gain * (1.0F + weighted * (level - 1.0F));
  });
  return factor.known() ? product(amplitude, factor) : kUnknown;
}

/// A smooth minimum never falls when an input rises, but for rounding.
Interval smooth_least(Interval a, Interval b, float k) {
  const float slack = (std::max(size_of(a), size_of(b)) + k) * 0x1p-20F;
  const auto smooth = [k](float u, float v) {
    const float h = greatest(k - std::abs(u - v), 0.0F) / k;
    return least(u, v) - ((h * h) * k) * 0.25F;
  };
  return widened({smooth(a.lo, b.lo), smooth(a.hi, b.hi)}, slack);
}

}  // namespace mc::graph
