// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "base/vectors.hpp"

namespace mc::process {

/// The point of a triangle that is nearest to another point.
struct NearestPoint {
  double square = 0;  ///< of the distance
  /// If the point lies on the side bc: the nearer one of b, 1, and c, 2; else 0.
  std::uint8_t far_corner = 0;
};

/// Finds the point of triangle abc that is nearest to p.
/// Source   Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
[[nodiscard]] inline NearestPoint nearest_point(const Vec3& p, const Vec3& a, const Vec3& b,
                                                const Vec3& c) {
  const auto from = [&p](const Vec3& q, int far_corner) {
    const Vec3 way = minus(p, q);
    return NearestPoint{dot(way, way), static_cast<std::uint8_t>(far_corner)};
  };
  const Vec3 ab = minus(b, a);
  const Vec3 ac = minus(c, a);
  const Vec3 ap = minus(p, a);
  const double d1 = dot(ab, ap);
  const double d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return from(a, 0);
  const Vec3 bp = minus(p, b);
  const double d3 = dot(ab, bp);
  const double d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return from(b, 1);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return from(moved(a, ab, d1 / (d1 - d3)), 0);
  const Vec3 cp = minus(p, c);
  const double d5 = dot(ab, cp);
  const double d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return from(c, 2);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return from(moved(a, ac, d2 / (d2 - d6)), 0);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) {
    const double along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return from(moved(b, minus(c, b), along), along < 0.5 ? 1 : 2);
  }
  const Vec3 normal = cross(ab, ac);
  const double height = dot(ap, normal);
  return {height * height / dot(normal, normal), 0};
}

}  // namespace mc::process
