// SPDX-License-Identifier: MIT
#pragma once

#include "graph/emitter.hpp"
#include "graph/node_types.hpp"

// Arithmetic: constants, coordinates and functions of other nodes.

namespace mc::graph {

inline Value emit_constant(Emitter& to, const Node& node, const Domain& /*domain*/) {
  return to.push(Op::fill, {}, node.numbers);
}

template <std::size_t kAxis>
Value emit_coordinate(Emitter& /*to*/, const Node& /*node*/, const Domain& domain) {
  return domain.at[kAxis];
}

template <Op kOp>
Value emit_unary(Emitter& to, const Node& node, const Domain& domain) {
  return to.push(kOp, {to.emit(node.inputs[0], domain)});
}

template <Op kOp>
Value emit_binary(Emitter& to, const Node& node, const Domain& domain) {
  const Value a = to.emit(node.inputs[0], domain);
  return to.push(kOp, {a, to.emit(node.inputs[1], domain)});
}

template <Op kOp>
Value emit_fold(Emitter& to, const Node& node, const Domain& domain) {
  return to.fold(kOp, node, domain);
}

inline Value emit_clamp(Emitter& to, const Node& node, const Domain& domain) {
  return to.push(Op::clamp, {to.emit(node.inputs[0], domain)}, node.numbers);
}

inline Value emit_remap(Emitter& to, const Node& node, const Domain& domain) {
  const auto& p = node.numbers;
  const Value source = to.emit(node.inputs[0], domain);
  return to.push(Op::remap, {source}, {p[0], (p[3] - p[2]) / (p[1] - p[0]), p[2]});
}

inline Value emit_smoothstep(Emitter& to, const Node& node, const Domain& domain) {
  const auto& p = node.numbers;
  return to.push(Op::smoothstep, {to.emit(node.inputs[0], domain)}, {p[0], p[1] - p[0]});
}

inline Value emit_mix(Emitter& to, const Node& node, const Domain& domain) {
  const Value a = to.emit(node.inputs[0], domain);
  const Value b = to.emit(node.inputs[1], domain);
  return to.push(Op::mix, {a, b, to.emit(node.inputs[2], domain)});
}

inline void check_clamp(Node& node, GivenKeys& given) {
  if (!(node.numbers[0] <= node.numbers[1])) {
    given.fault("min", "is above \"max\": expected at most that");
  }
}

inline void check_remap(Node& node, GivenKeys& given) {
  if (given["from"].is_complete && node.numbers[0] == node.numbers[1]) {
    given.fault("from", "has two equal numbers: expected two different ones (as float32)");
  }
}

inline void check_smoothstep(Node& node, GivenKeys& given) {
  if (given["edges"].is_complete && !(node.numbers[0] < node.numbers[1])) {
    given.fault("edges", "does not rise: expected the lower edge first (as float32)");
  }
}

inline constexpr NodeKey kSource = node_key("source");
inline constexpr NodeKey kA = node_key("a");
inline constexpr NodeKey kB = node_key("b");
inline constexpr NodeKey kInputs = plain_key("inputs", KeyKind::inputs);

inline constexpr NodeRow kArithmetic[] = {
    {.type = NodeType::constant,
     .name = "constant",
     .keys = {number_key("value", 0, kAnyFloat)},
     .emit = emit_constant},
    {.type = NodeType::x, .name = "x", .keys = {}, .emit = emit_coordinate<0>},
    {.type = NodeType::y, .name = "y", .keys = {}, .emit = emit_coordinate<1>},
    {.type = NodeType::z, .name = "z", .keys = {}, .emit = emit_coordinate<2>},
    {.type = NodeType::add, .name = "add", .keys = {kInputs}, .emit = emit_fold<Op::add>},
    {.type = NodeType::mul, .name = "mul", .keys = {kInputs}, .emit = emit_fold<Op::mul>},
    {.type = NodeType::min, .name = "min", .keys = {kInputs}, .emit = emit_fold<Op::min>},
    {.type = NodeType::max, .name = "max", .keys = {kInputs}, .emit = emit_fold<Op::max>},
    {.type = NodeType::sub, .name = "sub", .keys = {kA, kB}, .emit = emit_binary<Op::sub>},
    {.type = NodeType::div, .name = "div", .keys = {kA, kB}, .emit = emit_binary<Op::div>},
    {.type = NodeType::pow, .name = "pow", .keys = {kA, kB}, .emit = emit_binary<Op::pow>},
    {.type = NodeType::mod, .name = "mod", .keys = {kA, kB}, .emit = emit_binary<Op::mod>},
    {.type = NodeType::abs, .name = "abs", .keys = {kSource}, .emit = emit_unary<Op::abs>},
    {.type = NodeType::neg, .name = "neg", .keys = {kSource}, .emit = emit_unary<Op::neg>},
    {.type = NodeType::sqrt, .name = "sqrt", .keys = {kSource}, .emit = emit_unary<Op::sqrt>},
    {.type = NodeType::floor, .name = "floor", .keys = {kSource}, .emit = emit_unary<Op::floor>},
    {.type = NodeType::fract, .name = "fract", .keys = {kSource}, .emit = emit_unary<Op::fract>},
    {.type = NodeType::sin, .name = "sin", .keys = {kSource}, .emit = emit_unary<Op::sin>},
    {.type = NodeType::clamp,
     .name = "clamp",
     .keys = {kSource, number_key("min", 0, kAnyFloat), number_key("max", 1, kAnyFloat)},
     .emit = emit_clamp,
     .make = check_clamp},
    {.type = NodeType::remap,
     .name = "remap",
     .keys = {kSource, numbers_key("from", 2, 0, kAnyFloat), numbers_key("to", 2, 2, kAnyFloat)},
     .emit = emit_remap,
     .make = check_remap},
    {.type = NodeType::smoothstep,
     .name = "smoothstep",
     .keys = {kSource, numbers_key("edges", 2, 0, kAnyFloat)},
     .emit = emit_smoothstep,
     .make = check_smoothstep},
    {.type = NodeType::mix, .name = "mix", .keys = {kA, kB, node_key("t")}, .emit = emit_mix},
};

}  // namespace mc::graph
