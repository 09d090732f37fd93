// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "edit/brush.hpp"

// Distances and weights of eight samples at a time, in double, by IEEE-exact operations in a fixed
// order. Distances are exact but for the ellipsoid's, whose is exact to first order at the surface.
// Source   the usual closed forms (Hart, "Sphere tracing", 1996, appendix A; Quilez, "Distance
//          functions"), as in mc-volume(5).

namespace mc::edit {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double larger(double a, double b) { return b > a ? b : a; }
double smaller(double a, double b) { return b < a ? b : a; }
double clamped(double v, double lo, double hi) {
  const double raised = v < lo ? lo : v;
  return raised > hi ? hi : raised;
}
double length(double x, double y) { return __builtin_sqrt(x * x + y * y); }
double length(double x, double y, double z) { return __builtin_sqrt((x * x + y * y) + z * z); }

double box_distance(double x, double y, double z, const Vec3& half) {
  const double qx = std::abs(x) - half[0];
  const double qy = std::abs(y) - half[1];
  const double qz = std::abs(z) - half[2];
  const double outside = length(larger(qx, 0), larger(qy, 0), larger(qz, 0));
  return outside + smaller(larger(qx, larger(qy, qz)), 0);
}

double cylinder_distance(double x, double y, double z, const Vec3& half) {
  const double out = length(x, z) - half[0];
  const double over = std::abs(y) - half[1];
  return length(larger(out, 0), larger(over, 0)) + smaller(larger(out, over), 0);
}

/// The nearest point lies on a cap or on the slope; both distances are squared until the end.
double cone_distance(double x, double y, double z, const Vec3& size) {
  const double below = size[0];
  const double above = size[1];
  const double half = size[2];
  const double radial = length(x, z);
  const double cap_x = radial - smaller(radial, y < 0 ? below : above);
  const double cap_y = std::abs(y) - half;
  const double slope_x = above - below;
  const double slope_y = 2 * half;
  const double down_x = above - radial;
  const double down_y = half - y;
  const double along =
      (down_x * slope_x + down_y * slope_y) / (slope_x * slope_x + slope_y * slope_y);
  const double t = clamped(along, 0, 1);
  const double side_x = slope_x * t - down_x;
  const double side_y = slope_y * t - down_y;
  const double distance =
      __builtin_sqrt(smaller(side_x * side_x + side_y * side_y, cap_x * cap_x + cap_y * cap_y));
  return side_x < 0 && cap_y < 0 ? -distance : distance;
}

/// (k0 - 1) k0 / k1 with k0 = |p / r|, k1 = |p / r^2|; k0 / k1 is held within the radii.
double ellipsoid_distance(double px, double py, double pz, const Vec3& radii) {
  const double low = smaller(radii[0], smaller(radii[1], radii[2]));
  const double high = larger(radii[0], larger(radii[1], radii[2]));
  const double x = px / radii[0];
  const double y = py / radii[1];
  const double z = pz / radii[2];
  const double k0 = length(x, y, z);
  const double k1 = length(x / radii[0], y / radii[1], z / radii[2]);
  const double distance = (k0 - 1) * clamped(k0 / k1, low, high);
  return k0 < 0x1p-30 ? -low : distance;
}

/// Distances from a ball whose middle moves along a line: from the one that is nearest.
void measure_balls(const Position& at, const Places& p, Distances& out) noexcept {
  const auto& [ux, uy, uz] = at.along;
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    const double foot = (p.x[i] * ux + p.y[i] * uy) + p.z[i] * uz;
    const double radial = length(p.x[i] - ux * foot, p.y[i] - uy * foot, p.z[i] - uz * foot);
    const double s = clamped(foot - radial * at.slope, 0, at.length);
    out.r[i] = length(radial, foot - s);
    out.radius[i] = at.radius - at.taper * s;
    out.sd[i] = out.r[i] - out.radius[i];
  }
}

void measure_ball(const Position& at, const Places& p, Distances& out) noexcept {
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    out.r[i] = length(p.x[i], p.y[i], p.z[i]);
    out.radius[i] = at.radius;
    out.sd[i] = out.r[i] - at.radius;
  }
}

/// Moves the brush to the point of its line that is nearest to each sample.
void move_along(const Position& at, Places& p) noexcept {
  const auto& [ux, uy, uz] = at.along;
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    const double s = clamped((p.x[i] * ux + p.y[i] * uy) + p.z[i] * uz, 0, at.length);
    p.x[i] -= ux * s;
    p.y[i] -= uy * s;
    p.z[i] -= uz * s;
  }
}

template <class F>
void measure_each(const Brush& brush, const Places& p, Distances& out, F distance) {
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    out.sd[i] = distance(p.x[i], p.y[i], p.z[i], i);
    out.r[i] = brush.inradius + out.sd[i];
    out.radius[i] = brush.inradius;
  }
}

/// The node's solid, cut off by its bounds. What is not a number is outside.
double node_distance(const Brush& brush, double x, double y, double z, float value) {
  const double bounds =
      box_distance(x - brush.middle[0], y - brush.middle[1], z - brush.middle[2], brush.half);
  const double distance = -static_cast<double>(value);
  return distance == distance ? larger(bounds, distance) : kInfinity;
}

double curve_at(const std::vector<std::array<double, 2>>& points, double t) {
  std::size_t n = 1;
  while (n + 1 < points.size() && t > points[n][0]) ++n;
  const auto& [t0, w0] = points[n - 1];
  const auto& [t1, w1] = points[n];
  return clamped(w0 + (w1 - w0) * clamped((t - t0) / (t1 - t0), 0, 1), 0, 1);
}

template <class F>
void fall_off(const Brush& brush, const Distances& d, Row& out, F weight) {
  const double inner = brush.falloff.inner;
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    const double from = inner * d.radius[i];
    const double t = clamped((d.r[i] - from) / (d.radius[i] - from), 0, 1);
    const double w = weight(t);
    out[i] = d.sd[i] <= 0 ? (d.radius[i] > 0 ? w : 1) : 0;
  }
}

}  // namespace

void place_row(const Affine& map, std::int32_t i0, std::int32_t j, std::int32_t k,
               Places& out) noexcept {
  const auto& m = map.m;
  const auto coordinates = [&](std::size_t r, Row& to) {
    const double base = (m[r + 1] * j + m[r + 2] * k) + m[r + 3];
    for (std::int32_t i = 0; i < kBlockSize; ++i) {
      to[static_cast<std::size_t>(i)] = m[r] * (i0 + i) + base;
    }
  };
  coordinates(0, out.x);
  coordinates(4, out.y);
  coordinates(8, out.z);
}

void measure_row(const Brush& brush, const Position& at, Places& p, const float* node,
                 Distances& out) noexcept {
  if (brush.form == Form::ball) {
    return at.length > 0 ? measure_balls(at, p, out) : measure_ball(at, p, out);
  }
  if (at.length > 0) move_along(at, p);
  using D = double;
  switch (brush.form) {
    case Form::ball:
      return;
    case Form::box:
      return measure_each(brush, p, out, [&](D x, D y, D z, std::size_t) {
        return box_distance(x, y, z, brush.half) - brush.rounding;
      });
    case Form::cylinder:
      return measure_each(brush, p, out, [&](D x, D y, D z, std::size_t) {
        return cylinder_distance(x, y, z, brush.half) - brush.rounding;
      });
    case Form::cone:
      return measure_each(brush, p, out, [&](D x, D y, D z, std::size_t) {
        return cone_distance(x, y, z, brush.half);
      });
    case Form::ellipsoid:
      return measure_each(brush, p, out, [&](D x, D y, D z, std::size_t) {
        return ellipsoid_distance(x, y, z, brush.half);
      });
    case Form::plane:
      return measure_each(brush, p, out, [](D, D y, D, std::size_t) { return y; });
    case Form::node:
      return measure_each(brush, p, out, [&](D x, D y, D z, std::size_t i) {
        return node_distance(brush, x, y, z, node[i]);
      });
    case Form::everywhere:
      return measure_each(brush, p, out, [](D, D, D, std::size_t) { return D{0}; });
  }
}

void weigh_row(const Brush& brush, const Distances& d, Row& out) noexcept {
  switch (brush.falloff.type) {
    case FalloffType::none:
      for (std::size_t i = 0; i < kBlockSize; ++i) out[i] = d.sd[i] <= brush.reach ? 1 : 0;
      return;
    case FalloffType::hard:
      for (std::size_t i = 0; i < kBlockSize; ++i) out[i] = d.sd[i] <= 0 ? 1 : 0;
      return;
    case FalloffType::linear:
      return fall_off(brush, d, out, [](double t) { return 1 - t; });
    case FalloffType::smoothstep:
      return fall_off(brush, d, out, [](double t) { return 1 - t * t * (3 - 2 * t); });
    case FalloffType::smootherstep:
      return fall_off(brush, d, out,
                      [](double t) { return 1 - t * t * t * ((6 * t - 15) * t + 10); });
    case FalloffType::spherical:
      return fall_off(brush, d, out, [](double t) { return __builtin_sqrt(1 - t * t); });
    case FalloffType::tip:
      return fall_off(brush, d, out,
                      [](double t) { return 1 - __builtin_sqrt(1 - (1 - t) * (1 - t)); });
    case FalloffType::curve:
      return fall_off(brush, d, out, [&](double t) { return curve_at(brush.falloff.points, t); });
  }
}

bool misses(const Brush& brush, const Position& at, const IndexBox& box) noexcept {
  Vec3 middle;
  double apart = 0;  // of a corner from the middle, at most
  for (std::size_t a = 0; a < 3; ++a) {
    middle[a] = (static_cast<double>(box.lo[a]) + box.hi[a]) / 2;
    const auto& m = at.to_local.m;
    apart += length(m[a], m[4 + a], m[8 + a]) * (static_cast<double>(box.hi[a]) - box.lo[a]) / 2;
  }
  const Vec3 local = at.to_local(middle);
  Places p{};
  p.x.fill(local[0]);
  p.y.fill(local[1]);
  p.z.fill(local[2]);
  Distances d;
  switch (brush.form) {
    case Form::ball: {  // of the largest radius, so that tapering does not count
      Position largest = at;
      largest.radius = larger(at.radius, at.radius - at.taper * at.length);
      largest.taper = largest.slope = 0;
      measure_row(brush, largest, p, nullptr, d);
      break;
    }
    case Form::box:
    case Form::cylinder:
    case Form::cone:
    case Form::plane:
      measure_row(brush, at, p, nullptr, d);
      break;
    default:
      return false;
  }
  return d.sd[0] - apart > brush.reach + 1e-9 * (apart + std::abs(d.sd[0]));
}

}  // namespace mc::edit
