// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <type_traits>
#include <vector>

#include "edit/brush.hpp"
#include "field/visit_type.hpp"
#include "graph/float_math.hpp"
#include "mc/edit.hpp"

// Brush edits as their formulas say, sample by sample over the whole volume, one position after the
// other: no boxes, no blocks, no rows. Only where positions are in their own frames is asked of the
// room itself, since those maps decide the last bits.

namespace mc::test {

template <class T>
class ReferenceVolume {
 public:
  ReferenceVolume(const std::vector<T>& its_samples, Index3 its_dims, const EditRules& its_rules)
      : rules(its_rules),
        dims(its_dims),
        input(its_samples),
        samples(its_samples),
        materials(its_samples.size(), 0) {}

  void apply(const Edit& edit);

  EditRules rules;
  Index3 dims;
  std::vector<T> input;
  std::vector<T> samples;
  std::vector<std::uint16_t> materials;
  std::set<std::size_t> reached;  ///< by the last edit

 private:
  struct Weight {
    double w = 0;
    double sd = 0;
  };

  static double number(T v) { return static_cast<double>(field::number(v)); }
  static T narrowed(double v);
  static double mixed(double d, double b, double t) {
    if (t >= 1) return b;
    return std::isinf(d) ? d : d + (b - d) * t;
  }

  [[nodiscard]] std::size_t at(const Index3& p) const {
    return (static_cast<std::size_t>(p[2]) * static_cast<std::size_t>(dims[1]) +
            static_cast<std::size_t>(p[1])) *
               static_cast<std::size_t>(dims[0]) +
           static_cast<std::size_t>(p[0]);
  }
  [[nodiscard]] double held(const std::vector<T>& of, Index3 p) const {
    for (std::size_t a = 0; a < 3; ++a) p[a] = std::clamp(p[a], 0, dims[a] - 1);
    return number(of[at(p)]);
  }
  template <class F>
  void for_all(F f) const {
    for (std::int32_t k = 0; k < dims[2]; ++k) {
      for (std::int32_t j = 0; j < dims[1]; ++j) {
        for (std::int32_t i = 0; i < dims[0]; ++i) f(Index3{i, j, k});
      }
    }
  }
  static float graph_at(const GraphField& field, const Affine& map, const Index3& p) {
    float value = 0;
    field.sample(place(map, p), {0, 0, 0}, {0, 0, 0}, View3<float>(&value, {1, 1, 1}));
    return value;
  }
  /// m0 i + ((m1 j + m2 k) + m3)
  static Vec3 local(const Affine& map, const Index3& p) {
    Vec3 out;
    for (std::size_t r = 0; r < 3; ++r) {
      const double base = (map.m[4 * r + 1] * p[1] + map.m[4 * r + 2] * p[2]) + map.m[4 * r + 3];
      out[r] = map.m[4 * r] * p[0] + base;
    }
    return out;
  }
  static Vec3 place(const Affine& map, const Index3& p) {
    return map({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
  }
  static double size_of(const Vec3& v) {
    return std::sqrt((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
  }

  double shape_distance(const Edit& edit, const edit::Position& at, const Index3& p) const;
  Weight weight(const Edit& edit, const std::vector<edit::Position>& group, const Index3& p) const;
  double falloff(const Falloff& falloff, double r, double radius, double sd, double reach) const;
  double reach(const Edit& edit) const;
  double inradius(const Edit& edit) const;

  double mean(const Edit& edit, const std::vector<T>& before, const Index3& p) const;
  Vec3 gradient(const std::vector<T>& before, const Index3& p) const;
  std::optional<FlattenPlane> fitted(const std::vector<Weight>& weights,
                                     const std::vector<T>& before) const;
  double stamp(const Edit& edit, const edit::Position& at, const Index3& p) const;
  double csg(const Edit& edit, double d, double b, bool less) const;
  void apply_group(const Edit& edit, const std::vector<edit::Position>& group);
};

template <class T>
T ReferenceVolume<T>::narrowed(double v) {
  if constexpr (std::is_same_v<T, Half>) {
    return to_half(static_cast<float>(v));
  } else if constexpr (std::is_integral_v<T>) {
    if (v <= static_cast<double>(std::numeric_limits<T>::min())) {
      return std::numeric_limits<T>::min();
    }
    if (v >= static_cast<double>(std::numeric_limits<T>::max())) {
      return std::numeric_limits<T>::max();
    }
    return static_cast<T>(std::nearbyint(v));
  } else {
    return static_cast<T>(v);
  }
}

template <class T>
double ReferenceVolume<T>::inradius(const Edit& edit) const {
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

template <class T>
double ReferenceVolume<T>::reach(const Edit& edit) const {
  if (edit.blend != Blend::csg || edit.falloff.type != FalloffType::none) return 0;
  double most = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& m = rules.to_world.m;
    most = std::max(most, size_of({m[a], m[4 + a], m[8 + a]}));
  }
  return edit.smooth + 3 * most;
}

/// Of all shapes but balls.
template <class T>
double ReferenceVolume<T>::shape_distance(const Edit& edit, const edit::Position& at,
                                          const Index3& p) const {
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

template <class T>
double ReferenceVolume<T>::falloff(const Falloff& f, double r, double radius, double sd,
                                   double reach) const {
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

template <class T>
auto ReferenceVolume<T>::weight(const Edit& edit, const std::vector<edit::Position>& group,
                                const Index3& p) const -> Weight {
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
  out.w = falloff(edit.falloff, best_r, best_radius, out.sd, reach(edit));
  if (edit.op == EditOp::stamp && edit.falloff.type == FalloffType::none) out.w = 1;
  if (edit.mask) {
    const auto m = static_cast<double>(graph_at(*edit.mask, rules.to_world, p));
    out.w *= m > 0 ? std::min(m, 1.0) : 0;
  }
  return out;
}

template <class T>
double ReferenceVolume<T>::mean(const Edit& edit, const std::vector<T>& before,
                                const Index3& p) const {
  const auto n = static_cast<std::int32_t>(std::ceil(edit.kernel_radius));
  const auto weight_at = [&](std::int32_t d) {
    const double off = std::abs(d);
    if (edit.kernel == SmoothKernel::box) return off < n ? 1.0 : edit.kernel_radius - (n - 1);
    const double part = off / edit.kernel_radius;
    return static_cast<double>(graph::exact_exp2(
        static_cast<float>(std::max(-2 * part * part * 1.4426950408889634, -126.0))));
  };
  std::vector<double> window;
  double sum = 0, weights = 0;
  for (std::int32_t dk = -n; dk <= n; ++dk) {
    double plane = 0, plane_weights = 0;
    for (std::int32_t dj = -n; dj <= n; ++dj) {
      double line = 0, line_weights = 0;
      for (std::int32_t di = -n; di <= n; ++di) {
        const double v = held(before, {p[0] + di, p[1] + dj, p[2] + dk});
        if (!std::isnan(v)) window.push_back(v);
        line += weight_at(di) * (std::isnan(v) ? 0 : v);
        line_weights += weight_at(di) * (std::isnan(v) ? 0 : 1);
      }
      plane += weight_at(dj) * line;
      plane_weights += weight_at(dj) * line_weights;
    }
    sum += weight_at(dk) * plane;
    weights += weight_at(dk) * plane_weights;
  }
  if (edit.kernel != SmoothKernel::median) return sum / weights;
  if (window.empty()) return std::nan("");
  std::sort(window.begin(), window.end());
  return window[(window.size() - 1) / 2];
}

template <class T>
Vec3 ReferenceVolume<T>::gradient(const std::vector<T>& before, const Index3& p) const {
  Vec3 steps{};
  for (std::size_t a = 0; a < 3; ++a) {
    Index3 lo = p, hi = p;
    if (p[a] > 0) --lo[a];
    if (p[a] + 1 < dims[a]) ++hi[a];
    if (hi[a] > lo[a]) steps[a] = (held(before, hi) - held(before, lo)) / (hi[a] - lo[a]);
  }
  const Affine inverse = edit::inverse(rules.to_world);
  Vec3 out;
  for (std::size_t a = 0; a < 3; ++a) {
    out[a] = (inverse.m[a] * steps[0] + inverse.m[4 + a] * steps[1]) + inverse.m[8 + a] * steps[2];
  }
  return out;
}

template <class T>
double ReferenceVolume<T>::stamp(const Edit& edit, const edit::Position& at,
                                 const Index3& p) const {
  const SampledVolume& s = *edit.stamp;
  const Vec3 u = place(at.to_stamp, p);
  Index3 first{};
  Vec3 t{};
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(u[a] >= -1e-9 && u[a] <= s.dims[a] - 1 + 1e-9)) return std::nan("");
    const double v = std::clamp(u[a], 0.0, static_cast<double>(s.dims[a] - 1));
    first[a] = std::min(static_cast<std::int32_t>(v), std::max(s.dims[a] - 2, 0));
    t[a] = v - first[a];
  }
  const auto sample = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const Index3 q{std::min(first[0] + i, s.dims[0] - 1), std::min(first[1] + j, s.dims[1] - 1),
                   std::min(first[2] + k, s.dims[2] - 1)};
    return static_cast<double>(
        s.samples[static_cast<std::size_t>((q[2] * s.dims[1] + q[1]) * s.dims[0] + q[0])]);
  };
  const auto mix = [](double a, double b, double part) {
    return part > 0 ? a + (b - a) * part : a;
  };
  const auto plane = [&](std::int32_t k) {
    return mix(mix(sample(0, 0, k), sample(1, 0, k), t[0]),
               mix(sample(0, 1, k), sample(1, 1, k), t[0]), t[1]);
  };
  return mix(plane(0), plane(1), t[2]);
}

/// Union, or difference, of the field d and a solid whose field is b (difference: 2 iso - b).
template <class T>
double ReferenceVolume<T>::csg(const Edit& edit, double d, double b, bool less) const {
  double cut = 0;
  if (edit.smooth > 0) {
    const double h = std::max(edit.smooth - std::abs(d - b), 0.0) / edit.smooth;
    cut = h * h * edit.smooth / 4;
  }
  return rules.above != less ? std::max(d, b) + cut : std::min(d, b) - cut;
}

template <class T>
std::optional<FlattenPlane> ReferenceVolume<T>::fitted(const std::vector<Weight>& weights,
                                                       const std::vector<T>& before) const {
  // Sums go block by block, and within one row by row: that order is part of the result.
  double total = 0;
  Vec3 point{}, slope{};
  const auto block = [](std::int32_t n) { return (n + 7) / 8; };
  for (std::int32_t b = 0; b < block(dims[2]) * block(dims[1]) * block(dims[0]); ++b) {
    const std::int32_t nx = block(dims[0]), ny = block(dims[1]);
    const Index3 o{b % nx * 8, b / nx % ny * 8, b / nx / ny * 8};
    double part = 0;
    Vec3 part_point{}, part_slope{};
    for (std::int32_t n = 0; n < 512; ++n) {
      const Index3 p{o[0] + n % 8, o[1] + n / 8 % 8, o[2] + n / 64};
      if (p[0] >= dims[0] || p[1] >= dims[1] || p[2] >= dims[2]) continue;
      const double w = weights[at(p)].w;
      for (std::size_t a = 0; a < 3 && w > 0; ++a) {
        Index3 q = p;
        if (++q[a] >= dims[a]) continue;
        const double from = held(before, p), to = held(before, q);
        if ((from >= rules.iso) == (to >= rules.iso)) continue;
        const double t = (rules.iso - from) / (to - from);
        const Vec3 g = gradient(before, p);
        if (std::isnan(t) || std::isnan(size_of(g))) continue;
        Vec3 index{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
        index[a] += t;
        const Vec3 at_world = rules.to_world(index);
        part += w;
        for (std::size_t c = 0; c < 3; ++c) {
          part_point[c] += w * at_world[c];
          part_slope[c] += w * g[c];
        }
      }
    }
    total += part;
    for (std::size_t c = 0; c < 3; ++c) point[c] += part_point[c], slope[c] += part_slope[c];
  }
  const double steep = size_of(slope);
  if (!(total > 0) || !(steep > 0) || !std::isfinite(steep)) return std::nullopt;
  FlattenPlane out;
  for (std::size_t c = 0; c < 3; ++c) {
    out.point[c] = point[c] / total;
    out.normal[c] = (rules.above ? -slope[c] : slope[c]) / steep;
  }
  return out;
}

template <class T>
void ReferenceVolume<T>::apply_group(const Edit& edit, const std::vector<edit::Position>& group) {
  std::vector<Weight> weights(samples.size());
  for_all([&](const Index3& p) { weights[at(p)] = weight(edit, group, p); });
  std::optional<FlattenPlane> plane = edit.plane;
  if (edit.op == EditOp::flatten && !plane) {
    plane = fitted(weights, samples);
    if (!plane) return;
  }
  const double solid = rules.above ? 1 : -1;
  const double s = edit.strength;
  const std::uint32_t times = edit.steps * (edit.op == EditOp::smooth ? edit.iterations : 1);
  for (std::uint32_t n = 0; n < times; ++n) {
    const std::vector<T> before = samples;
    for_all([&](const Index3& p) {
      const Weight& here = weights[at(p)];
      double stamped = 0;
      if (edit.op == EditOp::stamp && here.w > 0) {
        stamped = stamp(edit, group.front(), p) - edit.stamp_iso;
        if (!edit.stamp_above) stamped = -stamped;
        if (std::isnan(stamped)) return;
      }
      if (!(here.w > 0)) return;
      reached.insert(at(p));
      const double d = number(before[at(p)]);
      const auto added = [&](double amount, double b) {
        const double sum = d + amount * here.w * b;
        return sum < edit.clamp[0] ? edit.clamp[0] : sum > edit.clamp[1] ? edit.clamp[1] : sum;
      };
      const double t = s * here.w;
      double value = d;
      switch (edit.op) {
        case EditOp::add:
        case EditOp::subtract: {
          const bool less = edit.op == EditOp::subtract;
          if (edit.blend == Blend::accumulate) {
            value = added(less ? -(solid * s) : solid * s, 1);
          } else {
            const double distance = less ? here.sd : -here.sd;
            value = mixed(d, csg(edit, d, rules.iso + solid * distance, less), t);
          }
          break;
        }
        case EditOp::set:
          value = mixed(d, edit.value, t);
          break;
        case EditOp::smooth:
          value = mixed(d, mean(edit, before, p), t);
          break;
        case EditOp::flatten: {
          const Vec3 q = place(rules.to_world, p);
          double distance = 0;
          for (std::size_t a = 0; a < 3; ++a)
            distance += (q[a] - plane->point[a]) * plane->normal[a];
          value = mixed(d, rules.iso - solid * distance, t);
          break;
        }
        case EditOp::inflate:
          value = added(solid * s, size_of(gradient(before, p)));
          break;
        case EditOp::noise: {
          const float noise = graph_at(*edit.noise, rules.to_world, p);
          value = added(solid * s, std::isnan(noise) ? 0 : static_cast<double>(noise));
          break;
        }
        case EditOp::revert:
          if (t >= 1) {
            samples[at(p)] = input[at(p)];
            return;
          }
          value = mixed(d, number(input[at(p)]), t);
          break;
        case EditOp::stamp: {
          const bool less = edit.stamp_carves;
          if (edit.blend == Blend::accumulate) {
            value = added(less ? -(solid * s) : solid * s, stamped);
          } else {
            const double b = rules.iso + solid * (less ? -stamped : stamped);
            value = mixed(d, csg(edit, d, b, less), t);
          }
          break;
        }
        case EditOp::paint:
          if (here.w >= 0.5) materials[at(p)] = edit.material;
          return;
        case EditOp::fill:
          return;
      }
      if (!std::isnan(d) && !std::isnan(value)) samples[at(p)] = narrowed(value);
    });
  }
}

template <class T>
void ReferenceVolume<T>::apply(const Edit& edit) {
  reached.clear();
  if (edit.op == EditOp::fill) {
    std::fill(samples.begin(), samples.end(), narrowed(edit.value));
    return;
  }
  const IndexBox all{{0, 0, 0}, {dims[0] - 1, dims[1] - 1, dims[2] - 1}};
  const edit::Stroke stroke = edit::lay_out(edit, rules, all, all);
  for (std::size_t n = 0; n < stroke.positions.size();) {
    std::vector<edit::Position> group;
    const std::uint32_t id = stroke.positions[n].group;
    for (; n < stroke.positions.size() && stroke.positions[n].group == id; ++n) {
      group.push_back(stroke.positions[n]);
    }
    apply_group(edit, group);
  }
}

}  // namespace mc::test
