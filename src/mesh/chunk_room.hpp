// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "mc/mesh.hpp"

// How far a chunk may grow. What is counted is the memory that its buffers hold, not only what they
// are filled with: while a buffer moves to larger memory, it is there twice.

namespace mc::mesh {

/// Bytes of one vertex in a chunk.
constexpr std::uint64_t vertex_bytes(Precision precision, bool has_normals) {
  return (precision == Precision::f64 ? 24 : 12) + (has_normals ? 12 : 0);
}
/// Bytes of one triangle in a chunk.
constexpr std::uint64_t kTriangleBytes = 3 * sizeof(std::uint32_t);

/// Bytes that a chunk is filled with.
constexpr std::uint64_t content_bytes(std::uint64_t n_vertices, std::uint64_t n_triangles,
                                      std::uint64_t vertex_bytes) {
  return n_vertices * vertex_bytes + n_triangles * kTriangleBytes;
}

class ChunkRoom {
 public:
  static constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

  ChunkRoom(MeshChunk& chunk, Precision precision, bool has_normals, std::uint64_t most_bytes)
      : chunk_(chunk),
        f64_(precision == Precision::f64),
        has_normals_(has_normals),
        most_bytes_(most_bytes) {}

  [[nodiscard]] MeshChunk& chunk() const { return chunk_; }

  /// Makes room for so many more vertices. Returns false where the chunk would outgrow its bytes.
  bool make_for_vertices(std::size_t n) {
    return (f64_ ? make(chunk_.positions_f64, 3 * n) : make(chunk_.positions, 3 * n)) &&
           (!has_normals_ || make(chunk_.normals, 3 * n));
  }
  bool make_for_indices(std::size_t n) { return make(chunk_.indices, n); }

 private:
  [[nodiscard]] std::uint64_t held() const {
    const auto bytes = [](const auto& buffer) {
      return std::uint64_t{buffer.capacity()} * sizeof(buffer[0]);
    };
    return bytes(chunk_.positions) + bytes(chunk_.positions_f64) + bytes(chunk_.normals) +
           bytes(chunk_.indices);
  }
  template <class T>
  bool make(Buffer<T>& buffer, std::size_t n_more) {
    const std::size_t needed = buffer.size() + n_more;
    return needed <= buffer.capacity() || move_to_larger(buffer, needed);
  }
  template <class T>
  bool move_to_larger(Buffer<T>& buffer, std::size_t needed) {
    const std::uint64_t there = held();
    const std::uint64_t left = (most_bytes_ - std::min(most_bytes_, there)) / sizeof(T);
    if (needed > left) return false;
    buffer.reserve(static_cast<std::size_t>(
        std::clamp<std::uint64_t>(2 * std::uint64_t{buffer.capacity()}, needed, left)));
    return true;
  }

  MeshChunk& chunk_;
  bool f64_, has_normals_;
  std::uint64_t most_bytes_;
};

}  // namespace mc::mesh
