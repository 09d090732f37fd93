// SPDX-License-Identifier: MIT
#include "mc/mesh.hpp"

#include <algorithm>

namespace mc {

void Bounds::include(const Vec3& p) {
  for (std::size_t a = 0; a < 3; ++a) {
    lo[a] = std::min(lo[a], p[a]);
    hi[a] = std::max(hi[a], p[a]);
  }
}

void Bounds::include(const Bounds& other) {
  if (!other.empty()) {
    include(other.lo);
    include(other.hi);
  }
}

std::int64_t MeshTotals::euler() const {
  const auto edges = (3 * n_triangles + n_boundary_edges) / 2;
  return static_cast<std::int64_t>(n_vertices) - static_cast<std::int64_t>(edges) +
         static_cast<std::int64_t>(n_triangles);
}

void MeshChunk::clear() {
  index_base = 0;
  positions.clear();
  positions_f64.clear();
  normals.clear();
  indices.clear();
  for (VertexAttribute& attribute : attributes) {
    attribute.values.clear();
  }
}

void Mesh::add_triangle(const std::array<std::uint64_t, 3>& ids) {
  const bool is_narrow = (ids[0] | ids[1] | ids[2]) >> 32 == 0;
  if (is_narrow && triangles_u64.empty()) {
    triangles.push_back({static_cast<std::uint32_t>(ids[0]), static_cast<std::uint32_t>(ids[1]),
                         static_cast<std::uint32_t>(ids[2])});
    return;
  }
  if (triangles_u64.empty()) {
    triangles_u64.reserve(std::max(triangles.capacity(), triangles.size() + 1));
    for (const auto& t : triangles) {
      triangles_u64.push_back({t[0], t[1], t[2]});
    }
    triangles = {};
  }
  triangles_u64.push_back(ids);
}

void Mesh::clear() {
  positions.clear();
  positions_f64.clear();
  normals.clear();
  triangles.clear();
  triangles_u64.clear();
  for (VertexAttribute& attribute : attributes) {
    attribute.values.clear();
  }
}

void MeshSink::set_slots(std::size_t /*n_slots*/) {}
void MeshSink::format(const MeshChunk& /*chunk*/, std::size_t /*slot*/) {}
void MeshSink::write(const MeshChunk& /*chunk*/, std::size_t /*slot*/) {}

void MeshSink::put(const MeshChunk& chunk) {
  format(chunk, 0);
  place(chunk, 0);
  write(chunk, 0);
}

}  // namespace mc
