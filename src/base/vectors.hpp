// SPDX-License-Identifier: MIT
#pragma once

#include "mc/base.hpp"

// Arithmetic of vectors in double, each sum in one fixed order.

namespace mc {

[[nodiscard]] inline double dot(const Vec3& a, const Vec3& b) {
  return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}
[[nodiscard]] inline double length(const Vec3& v) { return __builtin_sqrt(dot(v, v)); }
[[nodiscard]] inline Vec3 minus(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline Vec3 scaled(const Vec3& v, double s) { return {v[0] * s, v[1] * s, v[2] * s}; }
/// a + v s
[[nodiscard]] inline Vec3 moved(const Vec3& a, const Vec3& v, double s) {
  return {a[0] + v[0] * s, a[1] + v[1] * s, a[2] + v[2] * s};
}
[[nodiscard]] inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace mc
