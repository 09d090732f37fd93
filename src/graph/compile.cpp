// SPDX-License-Identifier: MIT
#include "graph/compile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "graph/data_uses.hpp"
#include "graph/hash.hpp"
#include "graph/lower.hpp"
#include "graph/reduce.hpp"
#include "graph/schedule.hpp"

// From a graph to straight-line code. A node is emitted once for each domain (coordinates, seed
// salt, dims) it is asked for in: fbm and warp ask for their source in domains of their own, all
// other nodes pass theirs on. Equal instructions are made once, and those of constants not at all.

namespace mc::graph {

namespace {

/// Where a node is evaluated.
struct Domain {
  std::array<Value, 3> at{};  // the coordinates x, y, z
  std::uint32_t salt = 0;     // changes the seeds below it; 0 leaves them
  std::optional<Dims> dims;   // of generators that do not say

  bool operator<(const Domain& other) const {
    return std::tie(at, salt, dims) < std::tie(other.at, other.salt, other.dims);
  }
};

/// The two axes of flat dims; those of xyz are all three.
constexpr std::array<std::array<std::uint8_t, 2>, 4> kDimsAxes{{{0, 1}, {0, 1}, {0, 2}, {1, 2}}};

class Emitter {
 public:
  explicit Emitter(const Graph& graph) : graph_(graph) {
    world_.at = {push(Op::x, {}), push(Op::y, {}), push(Op::z, {})};
  }

  Value emit_root(NodeId root) { return emit(root, world_); }
  std::vector<Instruction> take() { return std::move(code_); }
  std::vector<std::shared_ptr<const DataUse>> take_data() { return data_.take(); }

 private:
  /// The value of an instruction: a new one, or that of an equal instruction before it.
  Value push(Op op, std::initializer_list<Value> inputs, const std::array<float, 6>& p = {},
             std::uint32_t seed = 0, const DataUse* data = nullptr) {
    Instruction instruction{.op = op,
                            .out = static_cast<Value>(code_.size()),
                            .n_in = static_cast<std::uint8_t>(inputs.size()),
                            .seed = seed,
                            .p = p,
                            .data = data};
    std::copy(inputs.begin(), inputs.end(), instruction.in.begin());
    instruction = reduced(instruction, code_);
    if (code_.size() >= Graph::kMaxInstructions) {
      refuse();
    }
    const auto [known, is_new] = values_.try_emplace(recipe_of(instruction), instruction.out);
    if (is_new) {
      code_.push_back(instruction);
    }
    return known->second;
  }

  [[noreturn]] static void refuse() {
    throw Error(ErrorKind::usage, "",
                "fractals and warps expand to more than " +
                    std::to_string(Graph::kMaxInstructions) + " operations a sample",
                "nest fewer of them, or lower the octaves");
  }

  Value emit(NodeId id, const Domain& domain) {
    if (done_.size() > 4 * Graph::kMaxInstructions) {
      refuse();  // nodes that pass their input on cost no instruction, but memory here
    }
    const auto key = std::pair(id, domain);
    if (const auto known = done_.find(key); known != done_.end()) {
      return known->second;
    }
    const Value value = emit_new(graph_.node(id), domain);
    done_.emplace(key, value);
    return value;
  }

  Value emit_new(const Node& node, const Domain& domain);
  Value emit_arithmetic(const Node& node, const Domain& domain);
  Value emit_generator(const Node& node, const Domain& domain);
  Value emit_unity(const Node& node, const Domain& domain);
  Value emit_octave(const Node& node, const Domain& domain);
  Value emit_fractal(const Node& node, const Domain& domain);
  Value emit_weighted_fractal(const Node& node, const Domain& domain);
  std::array<Value, 3> emit_shifts(const Node& node, const Domain& domain, std::uint32_t octave,
                                   const Domain& at);
  Domain emit_warped(const Node& node, const Domain& domain);
  Value emit_warp(const Node& node, const Domain& domain);
  Value emit_select(const Node& node, const Domain& domain);
  Value emit_curve(const Node& node, const Domain& domain);
  Value emit_transform(const Node& node, const Domain& domain);
  Value emit_solid(const Node& node, const Domain& domain);
  Value emit_shell(const Node& node, const Domain& domain);
  Value emit_combination(const Node& node, const Domain& domain);
  Value emit_heightmap(const Node& node, const Domain& domain);
  Value emit_volume(const Node& node, const Domain& domain);

  Value unary(Op op, const Node& node, const Domain& domain, const std::array<float, 6>& p = {}) {
    return push(op, {emit(node.inputs[0], domain)}, p);
  }
  Value binary(Op op, const Node& node, const Domain& domain) {
    const Value a = emit(node.inputs[0], domain);
    return push(op, {a, emit(node.inputs[1], domain)});
  }
  /// Left to right.
  Value fold(Op op, const Node& node, const Domain& domain, const std::array<float, 6>& p = {}) {
    Value sum = emit(node.inputs[0], domain);
    for (std::size_t n = 1; n < node.inputs.size(); ++n) {
      sum = push(op, {sum, emit(node.inputs[n], domain)}, p);
    }
    return sum;
  }
  [[nodiscard]] bool density() const { return graph_.settings().convention == Convention::density; }
  Value linear(const Domain& domain, const float* row);
  std::array<Value, 3> moved(const Domain& domain, const std::vector<float>& matrix);
  Domain octave_of(const Node& node, const Domain& domain, std::uint32_t octave,
                   const Domain& previous);

  const Graph& graph_;
  std::vector<Instruction> code_;
  DataUses data_;
  std::map<std::pair<NodeId, Domain>, Value> done_;
  std::map<Recipe, Value> values_;
  Domain world_;
};

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

/// A generator's operation in two dimensions, and in three.
std::pair<Op, Op> noise_ops(NodeType type) {
  switch (type) {
    case NodeType::white:
      return {Op::white2, Op::white3};
    case NodeType::value:
      return {Op::value2, Op::value3};
    case NodeType::value_cubic:
      return {Op::value_cubic2, Op::value_cubic3};
    case NodeType::perlin:
      return {Op::perlin2, Op::perlin3};
    case NodeType::simplex:
      return {Op::simplex2, Op::simplex3};
    case NodeType::opensimplex2:
      return {Op::open_simplex2, Op::open_simplex3};
    default:
      return {Op::cellular2, Op::cellular3};
  }
}

Value Emitter::emit_generator(const Node& node, const Domain& domain) {
  const Dims dims = node.dims.value_or(domain.dims.value_or(Dims::xyz));
  const auto& axes = kDimsAxes[static_cast<std::size_t>(dims)];
  std::uint32_t seed = combine(graph_.settings().seed, node.seed);
  if (domain.salt != 0) {
    seed = combine(seed, domain.salt);
  }
  std::array<float, 6> p = node.numbers;
  if (node.type == NodeType::cellular) {
    p[2] = static_cast<float>(node.cell_return);
    p[3] = static_cast<float>(node.cell_metric);
  }
  const auto [flat, deep] = noise_ops(node.type);
  if (dims == Dims::xyz) {
    return push(deep, {domain.at[0], domain.at[1], domain.at[2]}, p, seed);
  }
  return push(flat, {domain.at[axes[0]], domain.at[axes[1]]}, p, seed);
}

Value Emitter::emit_unity(const Node& node, const Domain& domain) {
  if (!node.inputs.empty()) {
    const Value a = emit(node.inputs[0], domain);
    return push(Op::unity2, {a, emit(node.inputs[1], domain)}, {1.0F});
  }
  const Dims dims = node.dims.value_or(domain.dims.value_or(Dims::xz));
  const auto& axes = kDimsAxes[static_cast<std::size_t>(dims == Dims::xyz ? Dims::xz : dims)];
  return push(Op::unity2, {domain.at[axes[0]], domain.at[axes[1]]}, node.numbers);
}

Domain Emitter::octave_of(const Node& node, const Domain& domain, std::uint32_t octave,
                          const Domain& previous) {
  Domain next = previous;
  if (octave > 0) {
    for (Value& coordinate : next.at) {
      coordinate = push(Op::scale, {coordinate}, {node.numbers[0]});
    }
    next.salt = combine(domain.salt, octave);
  }
  if (node.dims) {
    next.dims = node.dims;
  }
  return next;
}

/// 1 + gain + gain^2 + ..., in float, first to last.
float total_amplitude(float gain, std::uint32_t octaves) {
  float sum = 0;
  float amplitude = 1;
  for (std::uint32_t octave = 0; octave < octaves; ++octave) {
    sum = sum + amplitude;
    amplitude = amplitude * gain;
  }
  return sum;
}

/// An octave of a fractal: its source, folded as the fractal's type says.
Value Emitter::emit_octave(const Node& node, const Domain& domain) {
  const Value value = emit(node.inputs[0], domain);
  switch (node.type) {
    case NodeType::ridged:
      return push(Op::ridge, {value});
    case NodeType::billow:
      return push(Op::billow, {value});
    case NodeType::pingpong:
      return push(Op::pingpong, {value}, {node.numbers[3]});
    default:
      return value;
  }
}

Value Emitter::emit_fractal(const Node& node, const Domain& domain) {
  const float total = total_amplitude(node.numbers[1], node.octaves);
  float amplitude = 1;
  Domain at = domain;
  Value sum = 0;
  for (std::uint32_t octave = 0; octave < node.octaves; ++octave) {
    at = octave_of(node, domain, octave, at);
    const Value value = emit_octave(node, at);
    const float weight = amplitude / total;
    sum = octave == 0 ? push(Op::scale, {value}, {weight})
                      : push(Op::accumulate, {sum, value}, {weight});
    amplitude = amplitude * node.numbers[1];
  }
  return sum;
}

Value Emitter::emit_weighted_fractal(const Node& node, const Domain& domain) {
  Domain at = domain;
  Value amplitude = push(Op::fill, {}, {1.0F});
  Value sum = 0;
  for (std::uint32_t octave = 0; octave < node.octaves; ++octave) {
    at = octave_of(node, domain, octave, at);
    const Value value = emit_octave(node, at);
    sum = octave == 0 ? value : push(Op::multiply_add, {sum, value, amplitude});
    amplitude = push(Op::weigh, {amplitude, value}, {node.numbers[1], node.numbers[2]});
  }
  return push(Op::scale, {sum}, {1.0F / total_amplitude(node.numbers[1], node.octaves)});
}

/// The warp of an octave at `at`, axis by axis, each with a seed of its own.
std::array<Value, 3> Emitter::emit_shifts(const Node& node, const Domain& domain,
                                          std::uint32_t octave, const Domain& at) {
  std::array<Value, 3> shifts{};
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    Domain salted = at;
    salted.salt = combine(domain.salt, 0x100U + axis);
    if (octave > 0) {
      salted.salt = combine(salted.salt, octave);
    }
    shifts[axis] = emit(node.inputs[1], salted);
  }
  return shifts;
}

/// Where the source is looked up.
Domain Emitter::emit_warped(const Node& node, const Domain& domain) {
  const bool single = node.warp_mode == WarpMode::single;
  const std::uint32_t octaves = single ? 1 : node.octaves;
  const float total = total_amplitude(node.numbers[2], octaves);
  const bool progressive = node.warp_mode == WarpMode::progressive;
  Domain moved = domain;
  Domain at = domain;
  float amplitude = 1;
  float frequency = 1;
  for (std::uint32_t octave = 0; octave < octaves; ++octave) {
    if (octave > 0) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        at.at[axis] =
            push(Op::scale, {progressive ? moved.at[axis] : domain.at[axis]}, {frequency});
      }
    }
    const std::array<Value, 3> shifts = emit_shifts(node, domain, octave, at);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      moved.at[axis] = push(Op::accumulate, {moved.at[axis], shifts[axis]},
                            {node.numbers[0] * (amplitude / total)});
    }
    amplitude = amplitude * node.numbers[2];
    frequency = frequency * node.numbers[1];
  }
  return moved;
}

Value Emitter::emit_warp(const Node& node, const Domain& domain) {
  return emit(node.inputs[0], emit_warped(node, domain));
}

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

Value Emitter::emit_heightmap(const Node& node, const Domain& domain) {
  Dims dims = node.dims.value_or(domain.dims.value_or(Dims::xz));
  if (dims == Dims::xyz) {
    dims = Dims::xz;
  }
  const auto& axes = kDimsAxes[static_cast<std::size_t>(dims)];
  std::array<float, 6> p = node.numbers;
  p[2] = static_cast<float>(node.raster->width) / p[2];
  p[3] = static_cast<float>(node.raster->height) / p[3];
  return push(Op::heightmap, {domain.at[axes[0]], domain.at[axes[1]]}, p, 0, data_.of(node));
}

Value Emitter::emit_volume(const Node& node, const Domain& domain) {
  return push(Op::volume, {domain.at[0], domain.at[1], domain.at[2]}, {}, 0, data_.of(node));
}

}  // namespace

Program compile(const Graph& graph, NodeId root) {
  Emitter emitter(graph);
  const Value result = emitter.emit_root(root);
  Program program = schedule(emitter.take(), result);
  program.data = emitter.take_data();
  return program;
}

}  // namespace mc::graph
