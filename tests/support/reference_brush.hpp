// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "edit/brush.hpp"
#include "mc/edit.hpp"

// What a brush weighs at one sample, as its formulas say: no boxes, no rows.

namespace mc::test::brush {

struct Weight {
  double w = 0;
  double sd = 0;  ///< signed distance to the shape
};

inline Vec3 place(const Affine& map, const Index3& p) {
  return map({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
}
/// A field, in world space, at the place of a sample.
inline float graph_at(const GraphField& field, const Affine& map, const Index3& p) {
  float value = 0;
  field.sample(place(map, p), {0, 0, 0}, {0, 0, 0}, View3<float>(&value, {1, 1, 1}));
  return value;
}

/// m0 i + ((m1 j + m2 k) + m3)
inline Vec3 local(const Affine& map, const Index3& p) {
  Vec3 out;
  for (std::size_t r = 0; r < 3; ++r) {
    const double base = (map.m[4 * r + 1] * p[1] + map.m[4 * r + 2] * p[2]) + map.m[4 * r + 3];
    out[r] = map.m[4 * r] * p[0] + base;
  }
  return out;
}

inline double size_of(const Vec3& v) {
  return std::sqrt((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
}

/// Radius of the largest ball in a shape.
inline double inradius(const Edit& edit) {
  const BrushShape& s = edit.shape;
  switch (s.type) {
    case ShapeType::box:
      return std::min({s.size[0], s.size[1], s.size[2]}) / 2;
    case ShapeType::cylinder:
      return std::min(s.radius, s.height / 2);
    case ShapeType::ellipsoid:
      return std::min({s.size[0], s.size[1], s.size[2]});
    case ShapeType::cone: {
      // The largest ball sits on the larger cap and touches the slope, or both caps.
      const double big = std::max(s.radius, s.end_radius);
      const double fall = (big - std::min(s.radius, s.end_radius)) / (2 * (s.height / 2));
      const double cosine = 1 / std::sqrt(1 + fall * fall);
      return std::min(s.height / 2, big * cosine / (1 + fall * cosine));
    }
    default:
      return s.radius;
  }
}

/// Beyond the shape, where an edit without falloff still works.
inline double reach(const Edit& edit, const EditRules& rules) {
  if (edit.blend != Blend::csg || edit.falloff.type != FalloffType::none) return 0;
  double most = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& m = rules.to_world.m;
    most = std::max(most, size_of({m[a], m[4 + a], m[8 + a]}));
  }
  return edit.smooth + 3 * most;
}

/// Of all shapes but balls.
inline double shape_distance(const Edit& edit, const edit::Position& at, const Index3& p) {
  const BrushShape& s = edit.shape;
  Vec3 q = local(at.to_local, p);
  if (at.length > 0) {
    const auto& u = at.along;
    const double t = std::clamp((q[0] * u[0] + q[1] * u[1]) + q[2] * u[2], 0.0, at.length);
    for (std::size_t a = 0; a < 3; ++a) q[a] -= u[a] * t;
  }
  const auto box = [](const Vec3& v, const Vec3& half) {
    const Vec3 d{std::abs(v[0]) - half[0], std::abs(v[1]) - half[1], std::abs(v[2]) - half[2]};
    const double outside = size_of({std::max(d[0], 0.0), std::max(d[1], 0.0), std::max(d[2], 0.0)});
    return outside + std::min(std::max(d[0], std::max(d[1], d[2])), 0.0);
  };
  switch (s.type) {
    case ShapeType::box:
      return box(q, {s.size[0] / 2 - s.rounding, s.size[1] / 2 - s.rounding,
                     s.size[2] / 2 - s.rounding}) -
             s.rounding;
    case ShapeType::cylinder: {
      const double out = std::sqrt(q[0] * q[0] + q[2] * q[2]) - (s.radius - s.rounding);
      const double over = std::abs(q[1]) - (s.height / 2 - s.rounding);
      const double ox = std::max(out, 0.0);
      const double oy = std::max(over, 0.0);
      return std::sqrt(ox * ox + oy * oy) + std::min(std::max(out, over), 0.0) - s.rounding;
    }
    case ShapeType::cone: {
      const double half = s.height / 2;
      const double r = std::sqrt(q[0] * q[0] + q[2] * q[2]);
      const double cap_x = r - std::min(r, q[1] < 0 ? s.radius : s.end_radius);
      const double cap_y = std::abs(q[1]) - half;
      const double sx = s.end_radius - s.radius;
      const double sy = 2 * half;
      const double dx = s.end_radius - r;
      const double dy = half - q[1];
      const double t = std::clamp((dx * sx + dy * sy) / (sx * sx + sy * sy), 0.0, 1.0);
      const double side_x = sx * t - dx;
      const double side_y = sy * t - dy;
      const double d =
          std::sqrt(std::min(side_x * side_x + side_y * side_y, cap_x * cap_x + cap_y * cap_y));
      return side_x < 0 && cap_y < 0 ? -d : d;
    }
    case ShapeType::ellipsoid: {
      const double low = std::min({s.size[0], s.size[1], s.size[2]});
      const double high = std::max({s.size[0], s.size[1], s.size[2]});
      const Vec3 v{q[0] / s.size[0], q[1] / s.size[1], q[2] / s.size[2]};
      const double k0 = size_of(v);
      const double k1 = size_of({v[0] / s.size[0], v[1] / s.size[1], v[2] / s.size[2]});
      return k0 < 0x1p-30 ? -low : (k0 - 1) * std::clamp(k0 / k1, low, high);
    }
    case ShapeType::plane:
      return q[1];
    case ShapeType::node: {
      const auto value = static_cast<double>(graph_at(*s.field, at.to_local, p));
      if (std::isnan(value)) return std::numeric_limits<double>::infinity();
      Vec3 middle, half;
      for (std::size_t a = 0; a < 3; ++a) {
        middle[a] = (s.bounds[0][a] + s.bounds[1][a]) / 2;
        half[a] = (s.bounds[1][a] - s.bounds[0][a]) / 2;
      }
      return std::max(box({q[0] - middle[0], q[1] - middle[1], q[2] - middle[2]}, half), -value);
    }
    default:
      return 0;
  }
}

inline double falloff(const Falloff& f, double r, double radius, double sd, double reach) {
  if (f.type == FalloffType::none) return sd <= reach ? 1 : 0;
  if (!(sd <= 0)) return 0;
  if (f.type == FalloffType::hard || !(radius > 0)) return 1;
  const double t = std::clamp((r - f.inner * radius) / (radius - f.inner * radius), 0.0, 1.0);
  switch (f.type) {
    case FalloffType::linear:
      return 1 - t;
    case FalloffType::smoothstep:
      return 1 - t * t * (3 - 2 * t);
    case FalloffType::smootherstep:
      return 1 - t * t * t * ((6 * t - 15) * t + 10);
    case FalloffType::spherical:
      return std::sqrt(1 - t * t);
    case FalloffType::tip:
      return 1 - std::sqrt(1 - (1 - t) * (1 - t));
    default:
      break;
  }
  std::size_t n = 1;
  while (n + 1 < f.points.size() && t > f.points[n][0]) ++n;
  const auto& a = f.points[n - 1];
  const auto& b = f.points[n];
  return std::clamp(a[1] + (b[1] - a[1]) * std::clamp((t - a[0]) / (b[0] - a[0]), 0.0, 1.0), 0.0,
                    1.0);
}

/// Of a group of positions at a sample.
inline Weight weight(const Edit& edit, const EditRules& rules,
                     const std::vector<edit::Position>& group, const Index3& p) {
  Weight out;
  double best_r = 0;
  double best_radius = 0;
  out.sd = std::numeric_limits<double>::infinity();
  const bool ball = edit.shape.type == ShapeType::sphere || edit.shape.type == ShapeType::capsule;
  for (const edit::Position& at : group) {
    double r, radius, sd;
    if (ball) {
      const Vec3 q = local(at.to_local, p);
      if (at.length > 0) {
        const auto& u = at.along;
        const double foot = (q[0] * u[0] + q[1] * u[1]) + q[2] * u[2];
        const double radial = size_of({q[0] - u[0] * foot, q[1] - u[1] * foot, q[2] - u[2] * foot});
        const double s = std::clamp(foot - radial * at.slope, 0.0, at.length);
        r = std::sqrt(radial * radial + (foot - s) * (foot - s));
        radius = at.radius - at.taper * s;
      } else {
        r = size_of(q);
        radius = at.radius;
      }
      sd = r - radius;
    } else {
      radius = inradius(edit);
      sd = shape_distance(edit, at, p);
      r = radius + sd;
    }
    if (sd < out.sd) out.sd = sd, best_r = r, best_radius = radius;
  }
  out.w = falloff(edit.falloff, best_r, best_radius, out.sd, reach(edit, rules));
  if (edit.op == EditOp::stamp && edit.falloff.type == FalloffType::none) out.w = 1;
  if (edit.mask) {
    const auto m = static_cast<double>(graph_at(*edit.mask, rules.to_world, p));
    out.w *= m > 0 ? std::min(m, 1.0) : 0;
  }
  return out;
}

}  // namespace mc::test::brush
