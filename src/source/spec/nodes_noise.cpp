// SPDX-License-Identifier: MIT
#include <optional>

#include "source/spec/node_numbers.hpp"
#include "source/spec/nodes.hpp"

// The keys of generators, fractals and warps.

namespace mc::source {

namespace {

constexpr std::int64_t kMostSeed = 0xFFFFFFFFLL;
constexpr NumberRange kLacunarity{1.0 / 64, 64, false, "a number from 1/64 to 64"};
constexpr NumberRange kGain{0, 8, false, "a number from 0 to 8"};
constexpr NumberRange kFraction{0, 1, false, "a number from 0 to 1"};
constexpr NumberRange kStrength{1.0 / 64, 64, false, "a number from 1/64 to 64"};

void take_dims(Node& node, ObjectReader& keys) {
  if (keys.optional("dims") != nullptr) {
    node.dims = Dims(keys.choice("dims", std::nullopt, {"xyz", "xy", "xz", "yz"}));
  }
}

void take_octaves(Node& node, ObjectReader& keys) {
  node.octaves = static_cast<std::uint32_t>(keys.integer("octaves", 4, 1, 32));
}

}  // namespace

void NodeLoader::fill_generator(Node& node, ObjectReader& keys) {
  put(node, 0, keys.number("frequency", 1, kPositiveFloat));
  node.seed = static_cast<std::uint32_t>(keys.integer("seed", 0, 0, kMostSeed));
  take_dims(node, keys);
  if (node.type == NodeType::cellular) {
    put(node, 1, keys.number("jitter", 1, kFraction));
    node.cell_return = CellReturn(keys.choice("return", 1, {"value", "f1", "f2", "f2-f1"}));
    node.cell_metric =
        CellMetric(keys.choice("metric", 0, {"euclidean", "manhattan", "chebyshev"}));
  }
}

void NodeLoader::fill_unity(Node& node, ObjectReader& keys) {
  const JsonValue* x = keys.optional("x");
  const JsonValue* y = keys.optional("y");
  put(node, 0, keys.number("frequency", 1, kPositiveFloat));
  const bool has_dims = keys.optional("dims") != nullptr;
  if (has_dims) {
    node.dims = Dims(keys.choice("dims", std::nullopt, {"xy", "xz", "yz"}) + 1);
  }
  if (x == nullptr && y == nullptr) {
    return;
  }
  if (x == nullptr || y == nullptr || has_dims || keys.value().find("frequency") != nullptr) {
    document_.fault(keys.value(), R"(expected either both "x" and "y", or "frequency" and "dims")");
    return;
  }
  node.inputs = {load(*x), load(*y)};
}

void NodeLoader::fill_fractal(Node& node, ObjectReader& keys) {
  take_input(node, keys, "source");
  take_octaves(node, keys);
  put(node, 0, keys.number("lacunarity", 2, kLacunarity));
  put(node, 1, keys.number("gain", 0.5, kGain));
  put(node, 2, keys.number("weighted", 0, kFraction));
  if (node.type == NodeType::pingpong) {
    put(node, 3, keys.number("strength", 2, kStrength));
  }
  take_dims(node, keys);
}

/// The keys of octaves belong to the modes that have some.
void NodeLoader::fill_warp(Node& node, ObjectReader& keys) {
  take_input(node, keys, "source");
  take_input(node, keys, "warp");
  put(node, 0, keys.number("amplitude", 1, kAnyFloat));
  node.warp_mode = WarpMode(keys.choice("mode", 0, {"single", "progressive", "independent"}));
  put(node, 1, 1);
  put(node, 2, 1);
  if (node.warp_mode != WarpMode::single) {
    take_octaves(node, keys);
    put(node, 1, keys.number("lacunarity", 2, kLacunarity));
    put(node, 2, keys.number("gain", 0.5, kGain));
  }
}

}  // namespace mc::source
