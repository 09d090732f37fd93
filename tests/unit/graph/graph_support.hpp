// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "mc/graph.hpp"

// Small ways to sample a graph in tests.

namespace mc::tests {

/// Values of `root` on a lattice of `dims`, x fastest.
inline std::vector<float> sampled(const Graph& graph, NodeId root, const Vec3& origin,
                                  const Vec3& spacing, const Index3& dims) {
  std::vector<float> out(static_cast<std::size_t>(dims[0]) * static_cast<std::size_t>(dims[1]) *
                         static_cast<std::size_t>(dims[2]));
  graph.compile(root).sample(origin, spacing, {0, 0, 0}, View3<float>(out.data(), dims));
  return out;
}

inline float value_at(const Graph& graph, NodeId root, const Vec3& p) {
  return sampled(graph, root, p, {1, 1, 1}, {1, 1, 1}).front();
}

inline Node make(NodeType type, std::vector<NodeId> inputs = {},
                 std::array<float, 6> numbers = {}) {
  Node node;
  node.type = type;
  node.inputs = std::move(inputs);
  node.numbers = numbers;
  return node;
}

/// FNV-1a over the bits; all NaNs count as one.
inline std::uint64_t hash_bits(const std::vector<float>& values) {
  std::uint64_t h = 0xCBF29CE484222325ULL;
  for (const float v : values) {
    const std::uint32_t bits = v != v ? 0x7FC00000U : std::bit_cast<std::uint32_t>(v);
    h = (h ^ bits) * 0x100000001B3ULL;
  }
  return h;
}

}  // namespace mc::tests
