// SPDX-License-Identifier: MIT
#include "graph/emitter.hpp"
#include "graph/hash.hpp"

// Generators, pictures and volumes, fractals and warps: what asks for values elsewhere, or under
// other seeds.

namespace mc::graph {

namespace {

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

}  // namespace

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

}  // namespace mc::graph
