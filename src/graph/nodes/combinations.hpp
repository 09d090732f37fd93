// SPDX-License-Identifier: MIT
#pragma once

#include "graph/nodes/arithmetic.hpp"

// Combinations of solids, which follow the convention.

namespace mc::graph {

/// The union where density is taken, the intersection where distances outside are.
inline Op union_of(const Emitter& to, bool smooth) {
  if (to.density()) return smooth ? Op::smooth_max : Op::max;
  return smooth ? Op::smooth_min : Op::min;
}
inline Op intersection_of(const Emitter& to, bool smooth) {
  if (to.density()) return smooth ? Op::smooth_min : Op::min;
  return smooth ? Op::smooth_max : Op::max;
}

inline Value emit_union(Emitter& to, const Node& node, const Domain& domain) {
  return to.fold(union_of(to, node.numbers[0] > 0), node, domain, node.numbers);
}

inline Value emit_intersection(Emitter& to, const Node& node, const Domain& domain) {
  return to.fold(intersection_of(to, node.numbers[0] > 0), node, domain, node.numbers);
}

/// 2 iso - value: what is outside.
inline Value emit_outside(Emitter& to, NodeId of, const Domain& domain) {
  return to.push(Op::mirror, {to.emit(of, domain)}, {2.0F * to.settings().iso});
}

inline Value emit_difference(Emitter& to, const Node& node, const Domain& domain) {
  const Value a = to.emit(node.inputs[0], domain);
  const Value outside_b = emit_outside(to, node.inputs[1], domain);
  return to.push(intersection_of(to, node.numbers[0] > 0), {a, outside_b}, node.numbers);
}

inline Value emit_complement(Emitter& to, const Node& node, const Domain& domain) {
  return emit_outside(to, node.inputs[0], domain);
}

/// v + s d, with s = 1 (density) or -1 (sdf).
inline Value emit_offset(Emitter& to, const Node& node, const Domain& domain) {
  const float sign = to.density() ? 1.0F : -1.0F;
  const Value source = to.emit(node.inputs[0], domain);
  return to.push(Op::offset, {source}, {sign * node.numbers[0]});
}

/// iso + s (t / 2 - |s (v - iso) - m|), m the depth of the shell's middle and t its thickness.
inline Value emit_shell(Emitter& to, const Node& node, const Domain& domain) {
  const float iso = to.settings().iso;
  const float sign = to.density() ? 1.0F : -1.0F;
  const float half = 0.5F * node.numbers[0];
  const Value source = to.emit(node.inputs[0], domain);
  const Value from_middle = to.push(Op::offset, {source}, {-(iso + sign * node.numbers[1])});
  return to.push(to.density() ? Op::mirror : Op::offset, {to.push(Op::abs, {from_middle})},
                 {iso + sign * half});
}

inline void make_shell(Node& node, GivenKeys& given) {
  constexpr std::array<double, 3> kDepth{0.5, 0, -0.5};
  node.numbers[1] = static_cast<float>(kDepth[given["side"].choice] * given.number("thickness"));
}

inline constexpr NodeKey kSmooth = or_else(number_key("smooth", 0, kFloatNotNegative), 0);

inline constexpr NodeRow kCombinations[] = {
    {.type = NodeType::unite, .name = "union", .keys = {kInputs, kSmooth}, .emit = emit_union},
    {.type = NodeType::intersect,
     .name = "intersection",
     .keys = {kInputs, kSmooth},
     .emit = emit_intersection},
    {.type = NodeType::difference,
     .name = "difference",
     .keys = {kA, kB, kSmooth},
     .emit = emit_difference},
    {.type = NodeType::complement,
     .name = "complement",
     .keys = {kSource},
     .emit = emit_complement},
    {.type = NodeType::offset,
     .name = "offset",
     .keys = {kSource, number_key("distance", 0, kAnyFloat)},
     .emit = emit_offset},
    {.type = NodeType::shell,
     .name = "shell",
     .keys = {kSource, number_key("thickness", 0, kPositiveFloat),
              or_else(choice_key("side", {"inside", "both", "outside"}), 0)},
     .emit = emit_shell,
     .make = make_shell},
};

}  // namespace mc::graph
