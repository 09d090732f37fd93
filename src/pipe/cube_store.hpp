// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "mc/mesh.hpp"

namespace mc::pipe {

/// Triangles of cubes, by (z, y, x).
using CubeCounts = std::map<std::array<std::int32_t, 3>, std::uint64_t>;

/// The mesh of the layers of cubes that one pass is about to make: vertices in the order in which
/// they came, and triangles by cube.
class CubeStore {
 public:
  static constexpr std::uint64_t kNoId = ~std::uint64_t{0};

  struct Cube {
    std::uint32_t serial = 0;  ///< no other cube of the store has it
    Buffer<std::uint32_t> triangles;
    std::size_t n_uses = 0;  ///< at least the number of vertices
    double n_extracted = 0;

    [[nodiscard]] std::size_t n_triangles() const { return triangles.size() / 3; }
  };
  struct Layer {
    std::map<std::pair<std::int32_t, std::int32_t>, Cube> cubes;  ///< by (y, x)
    std::uint32_t first_vertex = ~std::uint32_t{0}, last_vertex = 0;
  };
  using Triangle = std::array<std::uint32_t, 3>;

  [[nodiscard]] const MeshChunk& vertices() const { return vertices_; }
  [[nodiscard]] std::size_t n_vertices() const { return users_.size(); }
  /// Reserves memory for vertices, in either precision.
  void reserve(std::size_t n_vertices, Precision precision, bool has_normals);
  /// Appends all vertices of a chunk; triangles are left out.
  /// Errors   limit: 2^32 vertices at a time.
  void append(const MeshChunk& chunk);
  /// Appends one vertex of a chunk, and returns its number.
  std::uint32_t append(const MeshChunk& chunk, std::size_t vertex);
  /// Drops the first vertices, which no triangle uses.
  void drop_first(std::size_t n);
  /// Drops the vertices whose entry is 0, which no triangle uses. Returns the new number of each.
  std::vector<std::uint32_t> keep(std::span<const std::uint8_t> kept);

  /// Reserves memory for the triangles of cubes as they are made. Keeps a reference.
  void expect(const CubeCounts& counts) { expected_ = &counts; }
  /// Adds a triangle, which stands for `n_extracted` triangles of the first pass, to a cube.
  void add(const Index3& cube, const Triangle& triangle, double n_extracted);
  [[nodiscard]] Vec3 centroid(const Triangle& triangle) const;
  /// Whether a vertex has triangles in several cubes.
  [[nodiscard]] bool is_shared(std::uint32_t vertex) const { return users_[vertex] == kShared; }

  /// The layers by z, those below others first.
  [[nodiscard]] const std::map<std::int32_t, Layer>& layers() const { return layers_; }
  /// Takes out the lowest layer. Its vertices stay.
  Layer take_lowest();
  /// Sets the entry of each vertex to whether a triangle has it.
  void mark_used(std::vector<std::uint8_t>& used) const;

  /// The id of a vertex in the next mesh, or kNoId.
  std::uint64_t& next_id(std::uint32_t vertex) { return next_ids_[vertex]; }

 private:
  static constexpr std::uint32_t kUnused = 0xFFFFFFFF, kShared = 0xFFFFFFFE;

  void check_size(std::size_t n_more) const;
  void find(const Index3& cube);
  template <class Change>
  void change_numbers(Change&& change);

  MeshChunk vertices_;
  std::vector<std::uint32_t> users_;  ///< serial of the cube, kShared or kUnused
  std::vector<std::uint64_t> next_ids_;
  std::map<std::int32_t, Layer> layers_;
  const CubeCounts* expected_ = nullptr;
  Layer* latest_layer_ = nullptr;  ///< that add() was called for last, with its cube
  Cube* latest_ = nullptr;
  Index3 latest_at_{};
  std::uint32_t next_serial_ = 0;
};

/// Bytes that a store has for each vertex beside its mesh.
inline constexpr std::uint64_t kStoredVertexBytes = sizeof(std::uint32_t) + sizeof(std::uint64_t);

}  // namespace mc::pipe
