// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "mc/mesh.hpp"

// The JSON half of glTF: which bytes of the buffer are what.

namespace mc::sink {

/// Bytes of a vertex's attribute, which are a multiple of four; those at its end may be padding. A
/// material has its colour behind it.
[[nodiscard]] std::size_t attribute_bytes(const AttributeInfo& attribute);
/// Where the colour is in a material.
inline constexpr std::size_t kColourAt = 4;
/// Whether an attribute's numbers are of a type that glTF does not have: u32, i32, i64, f16, f64.
[[nodiscard]] bool becomes_float(SampleType type);

/// One object of a buffer, or the part of one: interleaved positions, normals and attributes, then
/// its indices.
struct GltfObject {
  std::string name;
  Vec3 origin{};
  bool has_normals = false;
  std::vector<AttributeInfo> attributes;
  std::uint64_t n_vertices = 0, n_indices = 0;
  std::uint64_t vertices_at = 0, indices_at = 0;  ///< bytes from the buffer's start
  std::array<float, 3> lo{}, hi{};                ///< of the positions as stored
  std::size_t buffer = 0;                         ///< number of the one it lies in
  bool continues = false;                         ///< a further primitive of the object before

  /// Bytes from a vertex's start.
  [[nodiscard]] std::uint64_t attributes_at() const { return has_normals ? 24 : 12; }
  [[nodiscard]] std::uint64_t vertex_bytes() const {
    std::uint64_t sum = attributes_at();
    for (const AttributeInfo& attribute : attributes) sum += attribute_bytes(attribute);
    return sum;
  }
  /// The greatest index a type holds is reserved.
  [[nodiscard]] bool has_short_indices() const { return n_vertices <= 0xFFFF; }
  [[nodiscard]] std::uint64_t index_bytes() const { return has_short_indices() ? 2 : 4; }
};

/// A buffer: its length, and the file that holds it (percent-encoded; empty for a GLB).
struct GltfBuffer {
  std::uint64_t n_bytes = 0;
  std::string uri = {};
};

/// The whole JSON text, one line for a GLB, indented otherwise. An object without triangles is a
/// node without mesh; without any, there are no buffers.
std::string gltf_json(std::span<const GltfObject> objects, std::span<const GltfBuffer> buffers,
                      std::span<const std::pair<std::string, std::string>> provenance);

}  // namespace mc::sink
