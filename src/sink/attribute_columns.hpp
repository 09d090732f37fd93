// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "mc/mesh.hpp"

// Attributes in the records and lines of vertices.

namespace mc::sink {

/// Vertices [first, last) of a chunk.
struct VertexRange {
  std::size_t first = 0, last = 0;
};

/// Writes an attribute of some vertices into records of `stride` bytes; `to` is its place in the
/// first. Its numbers keep their type, or become floats.
void put_attribute(const VertexAttribute& attribute, const VertexRange& vertices, bool as_floats,
                   std::byte* to, std::size_t stride);

/// Sets those of n_vertices * n_components floats that are not finite to 0 where put_attribute()
/// wrote them; returns how many.
std::uint64_t zero_not_finite(std::size_t n_vertices, std::size_t n_components, std::byte* to,
                              std::size_t stride);

/// Prints the numbers of a vertex, each after a space; returns the end. Needs at most
/// 1 + kMostDigits characters a number.
char* print_attribute(char* at, const VertexAttribute& attribute, std::size_t vertex);

}  // namespace mc::sink
