// SPDX-License-Identifier: MIT
#pragma once

#include "mc/base.hpp"

namespace mc::process {

/// Weighted sum of squared distances to planes, as a function of the point.
struct Quadric {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;  ///< of the quadratic part
  double x = 0, y = 0, z = 0;                             ///< half of the linear part
  double constant = 0;
  double weight = 0;

  /// Adds the plane through `point` with a unit normal.
  void add_plane(const Vec3& normal, const Vec3& point, double w) {
    const auto [nx, ny, nz] = normal;
    const double d = -((nx * point[0] + ny * point[1]) + nz * point[2]);
    xx += w * nx * nx;
    yy += w * ny * ny;
    zz += w * nz * nz;
    xy += w * nx * ny;
    xz += w * nx * nz;
    yz += w * ny * nz;
    x += w * nx * d;
    y += w * ny * d;
    z += w * nz * d;
    constant += w * d * d;
    weight += w;
  }
  void add(const Quadric& other) {
    xx += other.xx;
    yy += other.yy;
    zz += other.zz;
    xy += other.xy;
    xz += other.xz;
    yz += other.yz;
    x += other.x;
    y += other.y;
    z += other.z;
    constant += other.constant;
    weight += other.weight;
  }
  /// The sum at a point; rounding may make it less than 0.
  [[nodiscard]] double operator()(const Vec3& p) const {
    const double rx = xx * p[0] + 2 * (xy * p[1] + xz * p[2] + x);
    const double ry = yy * p[1] + 2 * (yz * p[2] + y);
    const double rz = zz * p[2] + 2 * z;
    return ((rx * p[0] + ry * p[1]) + rz * p[2]) + constant;
  }
};

}  // namespace mc::process
