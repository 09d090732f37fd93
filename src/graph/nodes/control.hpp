// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>

#include "graph/lower.hpp"
#include "graph/nodes/arithmetic.hpp"

// Choices and curves, which mc-volume(5) has under Arithmetic.

namespace mc::graph {

inline Value emit_select(Emitter& to, const Node& node, const Domain& domain) {
  const auto& p = node.numbers;
  const Value a = to.emit(node.inputs[0], domain);
  const Value b = to.emit(node.inputs[1], domain);
  const Value control = to.emit(node.inputs[2], domain);
  if (p[1] > 0) {
    return to.push(Op::blend, {a, b, control}, {p[0] - 0.5F * p[1], p[1]});
  }
  return to.push(Op::select, {a, b, control}, {p[0]});
}

inline Value emit_floor_hard(Emitter& to, const Node& node, const Domain& domain) {
  const auto& p = node.numbers;
  const Value source = to.emit(node.inputs[0], domain);
  const Value raised = to.push(Op::offset, {source}, {to.density() ? p[1] : -p[1]});
  return to.push(Op::select, {raised, source, domain.at[1]}, {p[0]});
}

inline Value emit_pieces(Emitter& to, Value source, const CurvePieces& curve) {
  Value value = to.push(Op::fill, {}, {curve.first});
  for (const Numbers& piece : curve.pieces) {
    value = to.push(Op::curve, {source, value}, piece);
  }
  const Value last = to.push(Op::fill, {}, {curve.last});
  return to.push(Op::select, {value, last, source}, {curve.end_x});
}

inline Value emit_curve(Emitter& to, const Node& node, const Domain& domain) {
  const Value source = to.emit(node.inputs[0], domain);
  return emit_pieces(to, source, curve_pieces(node.list, node.curve_shape));
}

inline Value emit_terrace(Emitter& to, const Node& node, const Domain& domain) {
  const auto& p = node.numbers;
  const Value source = to.emit(node.inputs[0], domain);
  if (!node.list.empty()) return emit_pieces(to, source, terrace_pieces(node.list, p[2]));
  const float steepness = p[2] > 0 ? 1.0F / p[2] : 0.0F;
  return to.push(Op::terrace, {source}, {p[0], 1.0F - p[2], steepness, p[1]});
}

inline bool is_curve(std::span<const float> list) {
  for (std::size_t at = 2; at < list.size(); at += 2) {
    if (!(list[at - 2] < list[at])) return false;
  }
  return list.size() >= 4 && list.size() % 2 == 0;
}

inline bool is_terrace(std::span<const float> list) {
  const auto stays = std::adjacent_find(list.begin(), list.end(), std::greater_equal<>());
  return list.empty() || (list.size() >= 2 && stays == list.end());
}

inline void check_terrace(Node& /*node*/, GivenKeys& given) {
  const bool of_levels = given["levels"].present;
  if (of_levels == given["step"].present || (of_levels && given["offset"].present)) {
    given.fault_of_all(R"(expected either "levels", or "step" and perhaps "offset")");
  }
}

inline constexpr NodeRow kControl[] = {
    {.type = NodeType::select,
     .name = "select",
     .keys = {kA, kB, node_key("control"), or_else(number_key("threshold", 0, kAnyFloat), 0),
              or_else(number_key("blend", 1, kFloatNotNegative), 0)},
     .emit = emit_select},
    {.type = NodeType::curve,
     .name = "curve",
     .keys = {kSource, plain_key("points", KeyKind::points),
              or_else(choice_key("interpolation", {"linear", "smooth", "steps"},
                                 [](Node& node, double n) { node.curve_shape = CurveShape(n); }),
                      0)},
     .emit = emit_curve,
     .takes_list = is_curve},
    {.type = NodeType::terrace,
     .name = "terrace",
     .keys = {kSource, or_else(number_key("ramp", 2, kFraction), 0.2),
              one_way(plain_key("levels", KeyKind::levels)),
              one_way(number_key("step", 0, kPositiveFloat)),
              or_else(number_key("offset", 1, kAnyFloat), 0)},
     .emit = emit_terrace,
     .make = check_terrace,
     .takes_list = is_terrace},
    {.type = NodeType::floor_hard,
     .name = "floor-hard",
     .keys = {kSource, or_else(number_key("height", 0, kAnyFloat), 0),
              number_key("weight", 1, kFloatNotNegative)},
     .emit = emit_floor_hard},
};

}  // namespace mc::graph
