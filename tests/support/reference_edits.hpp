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
#include "support/reference_brush.hpp"

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

  double mean(const Edit& edit, const std::vector<T>& before, const Index3& p) const;
  Vec3 gradient(const std::vector<T>& before, const Index3& p) const;
  std::optional<FlattenPlane> fitted(const std::vector<brush::Weight>& weights,
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
  const Vec3 u = brush::place(at.to_stamp, p);
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
std::optional<FlattenPlane> ReferenceVolume<T>::fitted(const std::vector<brush::Weight>& weights,
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
        if (std::isnan(t) || std::isnan(brush::size_of(g))) continue;
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
  const double steep = brush::size_of(slope);
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
  std::vector<brush::Weight> weights(samples.size());
  for_all([&](const Index3& p) { weights[at(p)] = brush::weight(edit, rules, group, p); });
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
      const brush::Weight& here = weights[at(p)];
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
          const Vec3 q = brush::place(rules.to_world, p);
          double distance = 0;
          for (std::size_t a = 0; a < 3; ++a)
            distance += (q[a] - plane->point[a]) * plane->normal[a];
          value = mixed(d, rules.iso - solid * distance, t);
          break;
        }
        case EditOp::inflate:
          value = added(solid * s, brush::size_of(gradient(before, p)));
          break;
        case EditOp::noise: {
          const float noise = brush::graph_at(*edit.noise, rules.to_world, p);
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
