// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>

#include "mc/edit.hpp"

// Seeded random edits of every kind around a region of the world, and the graphs that they use.

namespace mc::test {

/// A graph of one noise; values within +-1.
inline std::shared_ptr<const GraphField> noise_field(std::uint32_t seed, float frequency) {
  Graph graph({.seed = seed});
  Node node{.type = NodeType::perlin};
  node.numbers[0] = frequency;
  const NodeId id = graph.add(node);
  return std::make_shared<GraphField>(graph.compile(id));
}

/// A torus around the origin, positive inside.
inline std::shared_ptr<const GraphField> torus_field(float ring, float tube) {
  Graph graph({});
  Node node{.type = NodeType::torus};
  node.numbers = {0, 0, 0, ring, tube, 0};
  const NodeId id = graph.add(node);
  return std::make_shared<GraphField>(graph.compile(id));
}

/// What random edits are drawn from: places around `middle` within `span`, lengths up to `size`.
struct EditRange {
  Vec3 middle{};
  double span = 8;
  double size = 4;
  double value = 1;  ///< how large strengths and values are
};

class RandomEdits {
 public:
  RandomEdits(std::uint64_t seed, const EditRange& range) : random_(seed), range_(range) {}

  double real(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(random_);
  }
  std::uint32_t whole(std::uint32_t lo, std::uint32_t hi) {
    return std::uniform_int_distribution<std::uint32_t>(lo, hi)(random_);
  }
  bool chance(double p) { return real(0, 1) < p; }

  Edit next() {
    static constexpr std::array kOps{EditOp::add,      EditOp::add,     EditOp::subtract,
                                     EditOp::subtract, EditOp::set,     EditOp::smooth,
                                     EditOp::flatten,  EditOp::inflate, EditOp::noise,
                                     EditOp::revert,   EditOp::stamp,   EditOp::paint};
    return next(kOps[whole(0, kOps.size() - 1)]);
  }

  Edit next(EditOp op) {
    Edit edit;
    edit.op = op;
    const bool may_csg = op == EditOp::add || op == EditOp::subtract || op == EditOp::stamp;
    if (may_csg && chance(0.4)) edit.blend = Blend::csg;
    if (edit.blend == Blend::csg && chance(0.5)) edit.smooth = real(0, range_.size / 2);
    edit.shape = shape();
    edit.falloff = falloff();
    if (edit.blend == Blend::csg && chance(0.7)) edit.falloff.type = FalloffType::none;
    const bool adds = edit.blend == Blend::accumulate &&
                      (may_csg || op == EditOp::inflate || op == EditOp::noise);
    edit.strength = adds ? range_.value * real(0, 2) : chance(0.4) ? 1 : real(0, 1);
    edit.steps = chance(0.3) ? whole(2, 4) : 1;
    if (chance(0.3)) edit.clamp = {-range_.value, range_.value * 1.5};
    edit.value = real(-2, 2) * range_.value;
    edit.kernel = SmoothKernel(whole(0, 2));
    edit.kernel_radius = chance(0.5) ? 1 : real(0.5, 2);
    edit.iterations = chance(0.3) ? 2 : 1;
    if (op == EditOp::flatten && chance(0.5)) edit.plane = FlattenPlane{place(), direction()};
    if (op == EditOp::noise) edit.noise = noise_field(whole(0, 99), 0.3F);
    if (op == EditOp::stamp) set_stamp(edit);
    edit.material = static_cast<std::uint16_t>(whole(1, 9));
    if (chance(0.3)) edit.path = path(edit);
    if (chance(0.2)) edit.mirror = Mirror{{chance(0.5), chance(0.5), chance(0.5)}, place()};
    if (chance(0.2)) edit.radial = Radial{whole(1, 5), whole(0, 2), place()};
    if (chance(0.2)) edit.mask = noise_field(whole(0, 99), 0.2F);
    return edit;
  }

  Vec3 place() {
    Vec3 out = range_.middle;
    for (double& v : out) v += real(-range_.span, range_.span);
    return out;
  }

 private:
  double length() { return real(0.2, 1) * range_.size; }
  Vec3 direction() {
    Vec3 v{real(-1, 1), real(-1, 1), real(-1, 1)};
    const double size = std::sqrt((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
    if (size < 0.01) return {0, 1, 0};
    for (double& x : v) x /= size;
    return v;
  }
  /// A turn about y, then about x.
  Turn turn() {
    const double a = real(0, 6), b = real(0, 6);
    const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b);
    return {{ca, 0, sa, sb * sa, cb, -sb * ca, -cb * sa, sb, cb * ca}};
  }

  BrushShape shape() {
    BrushShape s;
    s.type = ShapeType(whole(0, 7));
    s.center = place();
    s.end = place();
    s.size = {length(), length(), length()};
    s.normal = direction();
    s.radius = length();
    s.end_radius = length();
    s.height = length();
    if (chance(0.7)) s.turn = turn();
    if (chance(0.3)) {
      s.rounding = std::min({s.size[0] / 2, s.size[1] / 2, s.size[2] / 2, s.radius, s.height / 2}) *
                   real(0, 1);
    }
    if (s.type == ShapeType::node) {
      const double ring = length(), tube = ring / 3;
      s.field = torus_field(static_cast<float>(ring), static_cast<float>(tube));
      const double w = ring + tube;
      s.bounds = {Vec3{-w, -tube, -w * real(0.3, 1)}, Vec3{w, tube, w}};
      s.radius = tube;
    }
    return s;
  }

  Falloff falloff() {
    Falloff f;
    f.type = FalloffType(whole(0, 6));
    f.inner = chance(0.5) ? 0 : real(0, 0.95);
    if (f.type == FalloffType::curve) f.points = {{0, 1}, {0.3, 0.9}, {0.6, 0.2}, {1, 0}};
    return f;
  }

  BrushPath path(const Edit& edit) {
    BrushPath out;
    for (std::uint32_t n = whole(2, 4); n > 0; --n) out.points.push_back(place());
    out.spacing = real(0.4, 1.5);
    const bool dabs = edit.op == EditOp::stamp || edit.shape.type == ShapeType::plane;
    out.mode = dabs || chance(0.5) ? PathMode::dabs : PathMode::sweep;
    return out;
  }

  void set_stamp(Edit& edit) {
    auto stamp = std::make_shared<SampledVolume>();
    stamp->dims = {4, 3, 5};
    for (int n = 0; n < 60; ++n) {
      stamp->samples.push_back(static_cast<float>(real(-1, 1) * range_.value));
    }
    const double scale = real(0.3, 1.2);
    edit.stamp_to_index = {{scale, 0.1, 0, -scale * range_.middle[0], 0, scale, 0,
                            -scale * range_.middle[1], 0, 0, scale, -scale * range_.middle[2]}};
    edit.stamp = std::move(stamp);
    edit.stamp_iso = real(-0.5, 0.5) * range_.value;
    edit.stamp_above = chance(0.5);
    edit.stamp_carves = chance(0.5);
    if (chance(0.6)) edit.falloff.type = FalloffType::none;
  }

  std::mt19937_64 random_;
  EditRange range_;
};

}  // namespace mc::test
