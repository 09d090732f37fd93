// SPDX-License-Identifier: MIT
#pragma once

#include "graph/hash.hpp"
#include "graph/nodes/arithmetic.hpp"

// Noises, and what adds up their octaves or moves what is looked up.

namespace mc::graph {

/// The two axes of flat dims; those of xyz are all three.
inline constexpr std::array<std::array<std::uint8_t, 2>, 4> kDimsAxes{
    {{0, 1}, {0, 1}, {0, 2}, {1, 2}}};

/// A noise, which has an operation in two dimensions and one in three.
inline Value push_noise(Emitter& to, const Node& node, const Domain& domain, Op flat, Op deep,
                        const Numbers& p) {
  const Dims dims = node.dims.value_or(domain.dims.value_or(Dims::xyz));
  const auto& axes = kDimsAxes[static_cast<std::size_t>(dims)];
  std::uint32_t seed = combine(to.settings().seed, node.seed);
  if (domain.salt != 0) {
    seed = combine(seed, domain.salt);
  }
  if (dims == Dims::xyz) {
    return to.push(deep, {domain.at[0], domain.at[1], domain.at[2]}, p, seed);
  }
  return to.push(flat, {domain.at[axes[0]], domain.at[axes[1]]}, p, seed);
}

template <Op kFlat, Op kDeep>
Value emit_noise(Emitter& to, const Node& node, const Domain& domain) {
  return push_noise(to, node, domain, kFlat, kDeep, node.numbers);
}

inline Value emit_cellular(Emitter& to, const Node& node, const Domain& domain) {
  Numbers p = node.numbers;
  p[2] = static_cast<float>(node.cell_return);
  p[3] = static_cast<float>(node.cell_metric);
  return push_noise(to, node, domain, Op::cellular2, Op::cellular3, p);
}

/// The axes that a node without a third dimension looks at.
inline std::array<std::uint8_t, 2> flat_axes(const Node& node, const Domain& domain) {
  const Dims dims = node.dims.value_or(domain.dims.value_or(Dims::xz));
  return kDimsAxes[static_cast<std::size_t>(dims == Dims::xyz ? Dims::xz : dims)];
}

inline Value emit_unity(Emitter& to, const Node& node, const Domain& domain) {
  if (!node.inputs.empty()) {
    const Value a = to.emit(node.inputs[0], domain);
    return to.push(Op::unity2, {a, to.emit(node.inputs[1], domain)}, {1.0F});
  }
  const auto axes = flat_axes(node, domain);
  return to.push(Op::unity2, {domain.at[axes[0]], domain.at[axes[1]]}, node.numbers);
}

/// 1 + gain + gain^2 + ..., in float, first to last.
inline float total_amplitude(float gain, std::uint32_t octaves) {
  float sum = 0;
  float amplitude = 1;
  for (std::uint32_t octave = 0; octave < octaves; ++octave) {
    sum = sum + amplitude;
    amplitude = amplitude * gain;
  }
  return sum;
}

/// Where a fractal looks up an octave; `previous` is where it looked up the one before.
inline Domain octave_of(Emitter& to, const Node& node, const Domain& domain, std::uint32_t octave,
                        const Domain& previous) {
  Domain next = previous;
  if (octave > 0) {
    for (Value& coordinate : next.at) {
      coordinate = to.push(Op::scale, {coordinate}, {node.numbers[0]});
    }
    next.salt = combine(domain.salt, octave);
  }
  if (node.dims) {
    next.dims = node.dims;
  }
  return next;
}

/// How a fractal changes each octave's value.
using Fold = Value (*)(Emitter& to, const Node& node, Value octave);

inline Value plain(Emitter& /*to*/, const Node& /*node*/, Value octave) { return octave; }
inline Value ridged(Emitter& to, const Node& /*node*/, Value octave) {
  return to.push(Op::ridge, {octave});
}
inline Value billowed(Emitter& to, const Node& /*node*/, Value octave) {
  return to.push(Op::billow, {octave});
}
inline Value to_and_fro(Emitter& to, const Node& node, Value octave) {
  return to.push(Op::pingpong, {octave}, {node.numbers[3]});
}

inline Value emit_weighted_fractal(Emitter& to, const Node& node, const Domain& domain, Fold fold) {
  Domain at = domain;
  Value amplitude = to.push(Op::fill, {}, {1.0F});
  Value sum = 0;
  for (std::uint32_t octave = 0; octave < node.octaves; ++octave) {
    at = octave_of(to, node, domain, octave, at);
    const Value value = fold(to, node, to.emit(node.inputs[0], at));
    sum = octave == 0 ? value : to.push(Op::multiply_add, {sum, value, amplitude});
    amplitude = to.push(Op::weigh, {amplitude, value}, {node.numbers[1], node.numbers[2]});
  }
  return to.push(Op::scale, {sum}, {1.0F / total_amplitude(node.numbers[1], node.octaves)});
}

template <Fold kFold>
Value emit_fractal(Emitter& to, const Node& node, const Domain& domain) {
  if (node.numbers[2] != 0) return emit_weighted_fractal(to, node, domain, kFold);
  const float total = total_amplitude(node.numbers[1], node.octaves);
  float amplitude = 1;
  Domain at = domain;
  Value sum = 0;
  for (std::uint32_t octave = 0; octave < node.octaves; ++octave) {
    at = octave_of(to, node, domain, octave, at);
    const Value value = kFold(to, node, to.emit(node.inputs[0], at));
    const float weight = amplitude / total;
    sum = octave == 0 ? to.push(Op::scale, {value}, {weight})
                      : to.push(Op::accumulate, {sum, value}, {weight});
    amplitude = amplitude * node.numbers[1];
  }
  return sum;
}

/// The warp of an octave at `at`, axis by axis, each with a seed of its own.
inline std::array<Value, 3> emit_shifts(Emitter& to, const Node& node, const Domain& domain,
                                        std::uint32_t octave, const Domain& at) {
  std::array<Value, 3> shifts{};
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    Domain salted = at;
    salted.salt = combine(domain.salt, 0x100U + axis);
    if (octave > 0) {
      salted.salt = combine(salted.salt, octave);
    }
    shifts[axis] = to.emit(node.inputs[1], salted);
  }
  return shifts;
}

inline Value emit_warp(Emitter& to, const Node& node, const Domain& domain) {
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
        const Value from = progressive ? moved.at[axis] : domain.at[axis];
        at.at[axis] = to.push(Op::scale, {from}, {frequency});
      }
    }
    const std::array<Value, 3> shifts = emit_shifts(to, node, domain, octave, at);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      moved.at[axis] = to.push(Op::accumulate, {moved.at[axis], shifts[axis]},
                               {node.numbers[0] * (amplitude / total)});
    }
    amplitude = amplitude * node.numbers[2];
    frequency = frequency * node.numbers[1];
  }
  return to.emit(node.inputs[0], moved);
}

inline void check_unity(Node& /*node*/, GivenKeys& given) {
  const bool has_x = given["x"].present;
  const bool has_y = given["y"].present;
  if (!has_x && !has_y) return;
  if (!has_x || !has_y || given["dims"].present || given["frequency"].present) {
    given.fault_of_all(R"(expected either both "x" and "y", or "frequency" and "dims")");
  }
}

inline bool has_octaves(const GivenKeys& given) { return given["mode"].choice != 0; }

inline constexpr NumberRange kSeeds{0, 4294967295.0, false, "an integer from 0 to 4294967295"};
inline constexpr NumberRange kOctaveCounts{1, 32, false, "an integer from 1 to 32"};
inline constexpr NumberRange kFactors{1.0 / 64, 64, false, "a number from 1/64 to 64"};
inline constexpr NumberRange kGains{0, 8, false, "a number from 0 to 8"};

inline constexpr NodeKey kFrequency = or_else(number_key("frequency", 0, kPositiveFloat), 1);
inline constexpr NodeKey kSeed =
    or_else(integer_key("seed", kSeeds,
                        [](Node& node, double n) { node.seed = static_cast<std::uint32_t>(n); }),
            0);
inline constexpr NodeKey kDims = or_nothing(choice_key(
    "dims", {"xyz", "xy", "xz", "yz"}, [](Node& node, double n) { node.dims = Dims(n); }));
/// Of a node that does not look at all three: xz, unless a fractal above it says otherwise.
inline constexpr NodeKey kFlatDims = inherited(
    choice_key("dims", {"xy", "xz", "yz"}, [](Node& node, double n) { node.dims = Dims(n + 1); }),
    1);
inline constexpr NodeKey kOctaves =
    or_else(integer_key("octaves", kOctaveCounts,
                        [](Node& node, double n) { node.octaves = static_cast<std::uint32_t>(n); }),
            4);
inline constexpr NodeKey kWeighted = or_else(number_key("weighted", 2, kFraction), 0);

constexpr NodeKey lacunarity_key(int at) {
  return or_else(number_key("lacunarity", at, kFactors), 2);
}
constexpr NodeKey gain_key(int at) { return or_else(number_key("gain", at, kGains), 0.5); }

inline constexpr NodeKeys kNoiseKeys{kFrequency, kSeed, kDims};
inline constexpr NodeKeys kFractalKeys{kSource,     kOctaves,  lacunarity_key(0),
                                       gain_key(1), kWeighted, kDims};

inline constexpr NodeRow kGenerators[] = {
    {.type = NodeType::white,
     .name = "white",
     .keys = kNoiseKeys,
     .emit = emit_noise<Op::white2, Op::white3>},
    {.type = NodeType::value,
     .name = "value",
     .keys = kNoiseKeys,
     .emit = emit_noise<Op::value2, Op::value3>},
    {.type = NodeType::value_cubic,
     .name = "value-cubic",
     .keys = kNoiseKeys,
     .emit = emit_noise<Op::value_cubic2, Op::value_cubic3>},
    {.type = NodeType::perlin,
     .name = "perlin",
     .keys = kNoiseKeys,
     .emit = emit_noise<Op::perlin2, Op::perlin3>},
    {.type = NodeType::simplex,
     .name = "simplex",
     .keys = kNoiseKeys,
     .emit = emit_noise<Op::simplex2, Op::simplex3>},
    {.type = NodeType::opensimplex2,
     .name = "opensimplex2",
     .keys = kNoiseKeys,
     .emit = emit_noise<Op::open_simplex2, Op::open_simplex3>},
    {.type = NodeType::cellular,
     .name = "cellular",
     .keys = {kFrequency, kSeed, kDims, or_else(number_key("jitter", 1, kFraction), 1),
              or_else(choice_key("return", {"value", "f1", "f2", "f2-f1"},
                                 [](Node& node, double n) { node.cell_return = CellReturn(n); }),
                      1),
              or_else(choice_key("metric", {"euclidean", "manhattan", "chebyshev"},
                                 [](Node& node, double n) { node.cell_metric = CellMetric(n); }),
                      0)},
     .emit = emit_cellular},
    {.type = NodeType::unity_perlin2d,
     .name = "unity-perlin2d",
     .keys = {one_way(plain_key("x", KeyKind::paired)), one_way(plain_key("y", KeyKind::paired)),
              kFrequency, kFlatDims},
     .emit = emit_unity,
     .make = check_unity},
    {.type = NodeType::fbm, .name = "fbm", .keys = kFractalKeys, .emit = emit_fractal<plain>},
    {.type = NodeType::ridged,
     .name = "ridged",
     .keys = kFractalKeys,
     .emit = emit_fractal<ridged>},
    {.type = NodeType::billow,
     .name = "billow",
     .keys = kFractalKeys,
     .emit = emit_fractal<billowed>},
    {.type = NodeType::pingpong,
     .name = "pingpong",
     .keys = {kSource, kOctaves, lacunarity_key(0), gain_key(1), kWeighted,
              or_else(number_key("strength", 3, kFactors), 2), kDims},
     .emit = emit_fractal<to_and_fro>},
    {.type = NodeType::warp,
     .name = "warp",
     .keys = {kSource, node_key("warp"), or_else(number_key("amplitude", 0, kAnyFloat), 1),
              or_else(choice_key("mode", {"single", "progressive", "independent"},
                                 [](Node& node, double n) { node.warp_mode = WarpMode(n); }),
                      0),
              only_if(kOctaves, has_octaves), only_if(lacunarity_key(1), has_octaves),
              only_if(gain_key(2), has_octaves)},
     .emit = emit_warp},
};

}  // namespace mc::graph
