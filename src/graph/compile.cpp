// SPDX-License-Identifier: MIT
#include "graph/compile.hpp"

#include "graph/emitter.hpp"
#include "graph/schedule.hpp"

namespace mc::graph {

Value Emitter::emit_new(const Node& node, const Domain& domain) {
  switch (node.type) {
    case NodeType::constant:
      return push(Op::fill, {}, node.numbers);
    case NodeType::x:
      return domain.at[0];
    case NodeType::y:
      return domain.at[1];
    case NodeType::z:
      return domain.at[2];
    case NodeType::white:
    case NodeType::value:
    case NodeType::value_cubic:
    case NodeType::perlin:
    case NodeType::simplex:
    case NodeType::opensimplex2:
    case NodeType::cellular:
      return emit_generator(node, domain);
    case NodeType::unity_perlin2d:
      return emit_unity(node, domain);
    case NodeType::fbm:
    case NodeType::ridged:
    case NodeType::billow:
    case NodeType::pingpong:
      return node.numbers[2] == 0 ? emit_fractal(node, domain)
                                  : emit_weighted_fractal(node, domain);
    case NodeType::warp:
      return emit_warp(node, domain);
    case NodeType::select:
    case NodeType::floor_hard:
      return emit_select(node, domain);
    case NodeType::curve:
    case NodeType::terrace:
      return emit_curve(node, domain);
    case NodeType::affine:
    case NodeType::mirror:
    case NodeType::repeat:
      return emit_transform(node, domain);
    case NodeType::sphere:
    case NodeType::box:
    case NodeType::plane:
    case NodeType::torus:
    case NodeType::roundbox:
    case NodeType::capsule:
    case NodeType::cylinder:
    case NodeType::cone:
    case NodeType::ellipsoid:
    case NodeType::gyroid:
      return emit_solid(node, domain);
    case NodeType::offset:
    case NodeType::shell:
      return emit_shell(node, domain);
    case NodeType::unite:
    case NodeType::intersect:
    case NodeType::difference:
    case NodeType::complement:
      return emit_combination(node, domain);
    case NodeType::heightmap:
      return emit_heightmap(node, domain);
    case NodeType::volume:
      return emit_volume(node, domain);
    default:
      return emit_arithmetic(node, domain);
  }
}

Value Emitter::emit_arithmetic(const Node& node, const Domain& domain) {
  const auto& p = node.numbers;
  switch (node.type) {
    case NodeType::add:
      return fold(Op::add, node, domain);
    case NodeType::mul:
      return fold(Op::mul, node, domain);
    case NodeType::min:
      return fold(Op::min, node, domain);
    case NodeType::max:
      return fold(Op::max, node, domain);
    case NodeType::sub:
      return binary(Op::sub, node, domain);
    case NodeType::div:
      return binary(Op::div, node, domain);
    case NodeType::pow:
      return binary(Op::pow, node, domain);
    case NodeType::mod:
      return binary(Op::mod, node, domain);
    case NodeType::abs:
      return unary(Op::abs, node, domain);
    case NodeType::neg:
      return unary(Op::neg, node, domain);
    case NodeType::sqrt:
      return unary(Op::sqrt, node, domain);
    case NodeType::floor:
      return unary(Op::floor, node, domain);
    case NodeType::fract:
      return unary(Op::fract, node, domain);
    case NodeType::sin:
      return unary(Op::sin, node, domain);
    case NodeType::clamp:
      return unary(Op::clamp, node, domain, p);
    case NodeType::remap:
      return unary(Op::remap, node, domain, {p[0], (p[3] - p[2]) / (p[1] - p[0]), p[2]});
    case NodeType::smoothstep:
      return unary(Op::smoothstep, node, domain, {p[0], p[1] - p[0]});
    default: {  // mix
      const Value a = emit(node.inputs[0], domain);
      const Value b = emit(node.inputs[1], domain);
      return push(Op::mix, {a, b, emit(node.inputs[2], domain)});
    }
  }
}

Program compile(const Graph& graph, NodeId root) {
  Emitter emitter(graph);
  const Value result = emitter.emit_root(root);
  Program program = schedule(emitter.take(), result);
  program.data = emitter.take_data();
  return program;
}

}  // namespace mc::graph
