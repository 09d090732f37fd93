// SPDX-License-Identifier: MIT
#include <limits>
#include <optional>

#include "graph/emitter.hpp"
#include "graph/lower.hpp"

// Choices and curves, transforms, solids and their combinations.

namespace mc::graph {

Value Emitter::emit_select(const Node& node, const Domain& domain) {
  const auto& p = node.numbers;
  const Value a = emit(node.inputs[0], domain);
  if (node.type == NodeType::floor_hard) {
    const Value raised = push(Op::offset, {a}, {density() ? p[1] : -p[1]});
    return push(Op::select, {raised, a, domain.at[1]}, {p[0]});
  }
  const Value b = emit(node.inputs[1], domain);
  const Value control = emit(node.inputs[2], domain);
  if (p[1] > 0) {
    return push(Op::blend, {a, b, control}, {p[0] - 0.5F * p[1], p[1]});
  }
  return push(Op::select, {a, b, control}, {p[0]});
}

Value Emitter::emit_curve(const Node& node, const Domain& domain) {
  const auto& p = node.numbers;
  const Value source = emit(node.inputs[0], domain);
  if (node.list.empty()) {  // a terrace of equal steps
    const float steepness = p[2] > 0 ? 1.0F / p[2] : 0.0F;
    return push(Op::terrace, {source}, {p[0], 1.0F - p[2], steepness, p[1]});
  }
  const CurvePieces curve = node.type == NodeType::curve ? curve_pieces(node.list, node.curve_shape)
                                                         : terrace_pieces(node.list, p[2]);
  Value value = push(Op::fill, {}, {curve.first});
  for (const Numbers& piece : curve.pieces) {
    value = push(Op::curve, {source, value}, piece);
  }
  const Value last = push(Op::fill, {}, {curve.last});
  return push(Op::select, {value, last, source}, {curve.end_x});
}

/// The products of coordinates and a matrix row, which ends with a number of its own, from left to
/// right; without those whose factor is 0, so that what does not depend on y is seen not to.
Value Emitter::linear(const Domain& domain, const float* row) {
  std::optional<Value> sum;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Value at = domain.at[axis];
    if (row[axis] != 0) {
      sum = sum              ? push(Op::accumulate, {*sum, at}, {row[axis]})
            : row[axis] == 1 ? at
                             : push(Op::scale, {at}, {row[axis]});
    }
  }
  if (!sum) {
    return push(Op::fill, {}, {row[3]});
  }
  return row[3] == 0 ? *sum : push(Op::offset, {*sum}, {row[3]});
}

std::array<Value, 3> Emitter::moved(const Domain& domain, const std::vector<float>& matrix) {
  return {linear(domain, &matrix[0]), linear(domain, &matrix[4]), linear(domain, &matrix[8])};
}

Value Emitter::emit_transform(const Node& node, const Domain& domain) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto& p = node.numbers;
  Domain there = domain;
  if (node.type == NodeType::affine) {
    there.at = moved(domain, node.list);
  } else if (node.type == NodeType::mirror) {
    Value& at = there.at[node.axis];
    const Value away = push(Op::abs, {push(Op::offset, {at}, {-p[0]})});
    at = push(p[1] > 0 ? Op::offset : Op::mirror, {away}, {p[0]});
  } else {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float copies = p[3 + axis];
      const float first = copies > 0 ? 0.0F : -kInfinity;
      const float last = copies > 0 ? copies - 1.0F : kInfinity;
      if (p[axis] > 0) {
        there.at[axis] = push(Op::repeat, {domain.at[axis]}, {p[axis], first, last});
      }
    }
  }
  const Value value = emit(node.inputs[0], there);
  const float iso = graph_.settings().iso;
  const bool scales = node.type == NodeType::affine && p[0] != 0;
  return scales ? push(Op::remap, {value}, {iso, p[0], iso}) : value;
}

Value Emitter::emit_solid(const Node& node, const Domain& domain) {
  std::array<Value, 3> at = domain.at;
  SolidCode code = solid_code(node);
  if (node.type == NodeType::capsule) {
    at = moved(domain, capsule_frame(node.list));
  } else if (code.turns_about_axis) {
    std::swap(at[1], at[node.axis]);
    std::swap(code.numbers[1], code.numbers[node.axis]);
  }
  Value inside = push(code.op, {at[0], at[1], at[2]}, code.numbers);
  if (node.type == NodeType::roundbox) {
    inside = push(Op::offset, {inside}, {node.list[0]});
  } else if (node.type == NodeType::gyroid && node.numbers[4] > 0) {
    inside = push(Op::mirror, {push(Op::abs, {inside})}, {0.5F * node.numbers[4]});
  }
  return push(density() ? Op::offset : Op::mirror, {inside}, {graph_.settings().iso});
}

/// With s = 1 (density) or -1 (sdf), m the depth of the shell's middle and t its thickness: offset
/// is v + s d; shell iso + s (t / 2 - |s (v - iso) - m|).
Value Emitter::emit_shell(const Node& node, const Domain& domain) {
  const float iso = graph_.settings().iso;
  const float sign = density() ? 1.0F : -1.0F;
  const Value source = emit(node.inputs[0], domain);
  if (node.type == NodeType::offset) {
    return push(Op::offset, {source}, {sign * node.numbers[0]});
  }
  const float half = 0.5F * node.numbers[0];
  const Value from_middle = push(Op::offset, {source}, {-(iso + sign * node.numbers[1])});
  return push(density() ? Op::mirror : Op::offset, {push(Op::abs, {from_middle})},
              {iso + sign * half});
}

Value Emitter::emit_combination(const Node& node, const Domain& domain) {
  const GraphSettings& settings = graph_.settings();
  const std::array<float, 6> twice_iso{2.0F * settings.iso};
  if (node.type == NodeType::complement) {
    return unary(Op::mirror, node, domain, twice_iso);
  }
  const bool takes_max =
      (node.type == NodeType::unite) == (settings.convention == Convention::density);
  const bool smooth = node.numbers[0] > 0;
  const Op largest = smooth ? Op::smooth_max : Op::max;
  const Op op = takes_max ? largest : (smooth ? Op::smooth_min : Op::min);
  if (node.type != NodeType::difference) {
    return fold(op, node, domain, node.numbers);
  }
  const Value a = emit(node.inputs[0], domain);
  const Value outside_b = push(Op::mirror, {emit(node.inputs[1], domain)}, twice_iso);
  return push(op, {a, outside_b}, node.numbers);
}

}  // namespace mc::graph
