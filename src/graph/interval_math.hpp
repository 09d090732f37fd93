// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "graph/bounds.hpp"

// Arithmetic of intervals, for ops.def and what it calls. Ends are computed by the float
// operations of the rows; what is not finite becomes unknown.

namespace mc::graph {

inline constexpr Interval kUnknown{};

/// [lo, hi], but unknown where an end is not finite: infinities would breed NaN further on.
inline Interval between(float lo, float hi) {
  constexpr float kMost = std::numeric_limits<float>::max();
  return lo >= -kMost && hi <= kMost && lo <= hi ? Interval{lo, hi} : kUnknown;
}

/// The hull of two numbers in any order.
inline Interval hull(float u, float v) { return v < u ? between(v, u) : between(u, v); }

/// All of both.
inline Interval joined(Interval a, Interval b) {
  return between(a.lo < b.lo ? a.lo : b.lo, a.hi > b.hi ? a.hi : b.hi);
}

inline Interval widened(Interval a, float by) { return between(a.lo - by, a.hi + by); }

/// The largest size of a number in it.
inline float size_of(Interval a) { return std::max(std::abs(a.lo), std::abs(a.hi)); }

inline bool holds_zero(Interval a) { return a.lo <= 0 && a.hi >= 0; }

inline Interval sum(Interval a, Interval b) { return between(a.lo + b.lo, a.hi + b.hi); }
inline Interval difference(Interval a, Interval b) { return between(a.lo - b.hi, a.hi - b.lo); }

template <class F>
Interval over_corners(Interval a, Interval b, F f) {
  const float v[4] = {f(a.lo, b.lo), f(a.lo, b.hi), f(a.hi, b.lo), f(a.hi, b.hi)};
  return between(std::min(std::min(v[0], v[1]), std::min(v[2], v[3])),
                 std::max(std::max(v[0], v[1]), std::max(v[2], v[3])));
}

inline Interval product(Interval a, Interval b) {
  return over_corners(a, b, [](float u, float v) { return u * v; });
}

inline Interval quotient(Interval a, Interval b) {
  if (holds_zero(b)) return kUnknown;
  return over_corners(a, b, [](float u, float v) { return u / v; });
}

inline Interval negative(Interval a) { return {-a.hi, -a.lo}; }

inline Interval magnitude(Interval a) {
  if (holds_zero(a)) return between(0, size_of(a));
  return hull(std::abs(a.lo), std::abs(a.hi));
}

inline Interval square(Interval a) {
  const Interval m = magnitude(a);
  return between(m.lo * m.lo, m.hi * m.hi);
}

inline Interval root(Interval a) {
  return a.lo >= 0 ? between(__builtin_sqrtf(a.lo), __builtin_sqrtf(a.hi)) : kUnknown;
}

/// Of a function that never falls.
template <class F>
Interval rising(Interval a, F f) {
  return between(f(a.lo), f(a.hi));
}

/// Of a function that never rises.
template <class F>
Interval falling(Interval a, F f) {
  return between(f(a.hi), f(a.lo));
}

/// Of a function that rises or falls throughout.
template <class F>
Interval monotone(Interval a, F f) {
  return hull(f(a.lo), f(a.hi));
}

}  // namespace mc::graph
