// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>

#include "graph/lower.hpp"
#include "graph/nodes/transforms.hpp"

// Solids: signed distances, added to iso or taken from it.

namespace mc::graph {

/// The field of a solid from the distance inside its surface.
inline Value emit_distance(Emitter& to, Value inside) {
  return to.push(to.density() ? Op::offset : Op::mirror, {inside}, {to.settings().iso});
}

template <Op kOp>
Value emit_solid(Emitter& to, const Node& node, const Domain& domain) {
  const auto& at = domain.at;
  return emit_distance(to, to.push(kOp, {at[0], at[1], at[2]}, node.numbers));
}

/// A solid around an axis: coordinates and centre are permuted so that the second runs along it.
inline Value emit_around(Emitter& to, const Node& node, const Domain& domain, Op op, Numbers p) {
  std::array<Value, 3> at = domain.at;
  std::swap(at[1], at[node.axis]);
  std::swap(p[1], p[node.axis]);
  return emit_distance(to, to.push(op, {at[0], at[1], at[2]}, p));
}

inline Value emit_torus(Emitter& to, const Node& node, const Domain& domain) {
  return emit_around(to, node, domain, Op::torus, node.numbers);
}

inline Value emit_cylinder(Emitter& to, const Node& node, const Domain& domain) {
  Numbers p = node.numbers;
  p[4] = 0.5F * p[4];
  return emit_around(to, node, domain, Op::cylinder, p);
}

inline Value emit_cone(Emitter& to, const Node& node, const Domain& domain) {
  Numbers p = node.numbers;
  p[5] = 0.5F * p[5];
  return emit_around(to, node, domain, Op::cone, p);
}

inline Value emit_roundbox(Emitter& to, const Node& node, const Domain& domain) {
  const auto& at = domain.at;
  const float radius = node.list[0];
  Numbers p = node.numbers;
  for (std::size_t axis = 3; axis < 6; ++axis) {
    p[axis] = p[axis] - 2.0F * radius;
  }
  const Value inner = to.push(Op::box, {at[0], at[1], at[2]}, p);
  return emit_distance(to, to.push(Op::offset, {inner}, {radius}));
}

inline Value emit_capsule(Emitter& to, const Node& node, const Domain& domain) {
  const Capsule capsule = capsule_of(node.list);
  const std::array<Value, 3> at = emit_moved(to, domain, capsule.frame);
  return emit_distance(to, to.push(Op::capsule, {at[0], at[1], at[2]}, capsule.numbers));
}

inline Value emit_gyroid(Emitter& to, const Node& node, const Domain& domain) {
  constexpr float kTurn = 6.28318531F;
  const auto& at = domain.at;
  Numbers p = node.numbers;
  p[3] = kTurn / p[3];
  Value inside = to.push(Op::gyroid, {at[0], at[1], at[2]}, p);
  if (node.numbers[4] > 0) {
    inside = to.push(Op::mirror, {to.push(Op::abs, {inside})}, {0.5F * node.numbers[4]});
  }
  return emit_distance(to, inside);
}

inline void make_plane(Node& node, GivenKeys& given) {
  const auto n = direction_of(given, "normal");
  for (std::size_t axis = 0; n && axis < 3; ++axis) {
    node.numbers[axis] = static_cast<float>((*n)[axis]);
  }
}

inline void make_roundbox(Node& node, GivenKeys& given) {
  const double radius = given.number("radius");
  const Vec3 size = given.vector("size");
  node.list = {static_cast<float>(radius)};
  if (given["size"].present && 2 * radius > *std::min_element(size.begin(), size.end())) {
    given.fault("radius", "expected at most half the least of \"size\"", true);
  }
}

inline void make_capsule(Node& node, GivenKeys& given) {
  for (const char* end : {"from", "to"}) {
    for (const double v : given.vector(end)) node.list.push_back(static_cast<float>(v));
  }
  const auto& radius = given["radius"].numbers;
  node.list.push_back(static_cast<float>(radius[0]));
  node.list.push_back(static_cast<float>(radius[1]));
}

inline constexpr NodeKey kSolidCenter = or_else(numbers_key("center", 3, 0, kAnyFloat), 0);
inline constexpr NodeKey kRadius = number_key("radius", 3, kPositiveFloat);
inline constexpr NodeKey kAxis = or_else(choice_key("axis", {"x", "y", "z"}, set_axis), 1);

inline constexpr NodeRow kSolids[] = {
    {.type = NodeType::sphere,
     .name = "sphere",
     .keys = {kSolidCenter, kRadius},
     .emit = emit_solid<Op::sphere>},
    {.type = NodeType::box,
     .name = "box",
     .keys = {kSolidCenter, sizes_key("size", 3, 3, kPositiveFloat)},
     .emit = emit_solid<Op::box>},
    {.type = NodeType::plane,
     .name = "plane",
     .keys = {or_else(numbers_key("normal", 3, -1, kAnyFloat), 0, 1, 0),
              or_else(number_key("offset", 3, kAnyFloat), 0)},
     .emit = emit_solid<Op::plane>,
     .make = make_plane},
    {.type = NodeType::torus,
     .name = "torus",
     .keys = {kSolidCenter, kRadius, number_key("tube", 4, kPositiveFloat), kAxis},
     .emit = emit_torus},
    {.type = NodeType::roundbox,
     .name = "roundbox",
     .keys = {kSolidCenter, sizes_key("size", 3, 3, kPositiveFloat),
              number_key("radius", -1, kPositiveFloat)},
     .emit = emit_roundbox,
     .make = make_roundbox,
     .takes_list = [](std::span<const float> list) { return list.size() == 1; }},
    {.type = NodeType::capsule,
     .name = "capsule",
     .keys = {numbers_key("from", 3, -1, kAnyFloat), numbers_key("to", 3, -1, kAnyFloat),
              sizes_key("radius", 2, -1, kPositiveFloat)},
     .emit = emit_capsule,
     .make = make_capsule,
     .takes_list = [](std::span<const float> list) { return list.size() == 8; }},
    {.type = NodeType::cylinder,
     .name = "cylinder",
     .keys = {kSolidCenter, kRadius, number_key("height", 4, kPositiveFloat), kAxis},
     .emit = emit_cylinder},
    {.type = NodeType::cone,
     .name = "cone",
     .keys = {kSolidCenter,
              not_all_zero(one_or_more_key("radius", 2, 3, kPositiveFloat, kFloatNotNegative),
                           "has two zeros: expected one number above 0"),
              number_key("height", 5, kPositiveFloat), kAxis},
     .emit = emit_cone},
    {.type = NodeType::ellipsoid,
     .name = "ellipsoid",
     .keys = {kSolidCenter, sizes_key("radii", 3, 3, kPositiveFloat)},
     .emit = emit_solid<Op::ellipsoid>},
    {.type = NodeType::gyroid,
     .name = "gyroid",
     .keys = {kSolidCenter, number_key("period", 3, kPositiveFloat),
              or_nothing(number_key("thickness", 4, kPositiveFloat))},
     .emit = emit_gyroid},
};

}  // namespace mc::graph
