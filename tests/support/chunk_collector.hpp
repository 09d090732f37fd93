// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "mc/pipe.hpp"

// A surface in chunks as one who follows a mesher keeps it, and as one mesh again.

namespace mc::test {

/// What a chunk hands out, to compare.
struct KeptChunk {
  Buffer<float> positions;
  Buffer<double> positions_f64;
  Buffer<float> normals;
  std::vector<VertexAttribute> attributes;
  Buffer<std::uint32_t> indices;
  std::uint64_t n_vertices = 0, n_triangles = 0, n_boundary_edges = 0;
  std::array<double, 6> bounds{};

  explicit KeptChunk(const SurfaceChunk& c)
      : positions(c.mesh.positions),
        positions_f64(c.mesh.positions_f64),
        normals(c.mesh.normals),
        attributes(c.mesh.attributes),
        indices(c.mesh.indices),
        n_vertices(c.totals.n_vertices),
        n_triangles(c.totals.n_triangles),
        n_boundary_edges(c.totals.n_boundary_edges) {
    std::copy_n(c.totals.bounds.lo.begin(), 3, bounds.begin());
    std::copy_n(c.totals.bounds.hi.begin(), 3, bounds.begin() + 3);
  }
  bool operator==(const KeptChunk&) const = default;
};

/// Keeps chunks up to date.
class ChunkCollector {
 public:
  /// Orders by (z, y, x).
  struct Before {
    bool operator()(const Index3& a, const Index3& b) const {
      return std::tie(a[2], a[1], a[0]) < std::tie(b[2], b[1], b[0]);
    }
  };
  using Chunks = std::map<Index3, KeptChunk, Before>;

  /// To hand to build() and update().
  [[nodiscard]] ChunkMesher::Take take() {
    last_ = {};
    n_taken_ = n_removed_ = 0;
    return [this](const SurfaceChunk& chunk) { enter(chunk); };
  }
  [[nodiscard]] const Chunks& chunks() const { return chunks_; }
  [[nodiscard]] std::size_t n_taken() const { return n_taken_; }  ///< in the last call
  [[nodiscard]] std::size_t n_removed() const { return n_removed_; }
  [[nodiscard]] bool in_order() const { return in_order_; }  ///< all calls so far
  /// A chunk came without a surface that had none before.
  [[nodiscard]] bool told_of_nothing() const { return told_of_nothing_; }

 private:
  void enter(const SurfaceChunk& chunk) {
    in_order_ = in_order_ && (n_taken_ == 0 || Before()(last_, chunk.id));
    last_ = chunk.id;
    ++n_taken_;
    const std::size_t n_erased = chunks_.erase(chunk.id);
    if (chunk.mesh.n_triangles() == 0) {
      ++n_removed_;
      told_of_nothing_ = told_of_nothing_ || n_erased == 0;
    } else {
      chunks_.emplace(chunk.id, KeptChunk(chunk));
    }
  }

  Chunks chunks_;
  Index3 last_{};
  std::size_t n_taken_ = 0, n_removed_ = 0;
  bool in_order_ = true, told_of_nothing_ = false;
};

/// A surface without numbers: each vertex by the bits of its place and normal, each triangle by its
/// vertices from the least one on.
struct WeldedSurface {
  using Vertex = std::array<std::uint32_t, 6>;
  std::vector<Vertex> vertices;  ///< each once
  std::vector<std::array<Vertex, 3>> triangles;

  /// Three floats a vertex, three ids a triangle.
  void add(const float* positions, const float* normals, std::size_t n_vertices,
           const std::uint32_t* indices, std::size_t n_indices) {
    std::vector<Vertex> own(n_vertices);
    for (std::size_t v = 0; v < n_vertices; ++v) {
      for (std::size_t a = 0; a < 3; ++a) {
        own[v][a] = std::bit_cast<std::uint32_t>(positions[3 * v + a]);
        if (normals != nullptr) own[v][3 + a] = std::bit_cast<std::uint32_t>(normals[3 * v + a]);
      }
    }
    for (std::size_t n = 0; n < n_indices; n += 3) {
      std::array<Vertex, 3> t{own[indices[n]], own[indices[n + 1]], own[indices[n + 2]]};
      std::rotate(t.begin(), std::ranges::min_element(t), t.end());
      triangles.push_back(t);
    }
    vertices.insert(vertices.end(), own.begin(), own.end());
  }
  void sort() {
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::ranges::sort(triangles);
  }
  bool operator==(const WeldedSurface&) const = default;
};

inline WeldedSurface welded(const Mesh& mesh) {
  WeldedSurface out;
  out.add(reinterpret_cast<const float*>(mesh.positions.data()),
          mesh.normals.empty() ? nullptr : reinterpret_cast<const float*>(mesh.normals.data()),
          mesh.positions.size(), reinterpret_cast<const std::uint32_t*>(mesh.triangles.data()),
          3 * mesh.triangles.size());
  out.sort();
  return out;
}

inline WeldedSurface welded(const ChunkCollector::Chunks& chunks) {
  WeldedSurface out;
  for (const auto& [id, chunk] : chunks) {
    out.add(chunk.positions.data(), chunk.normals.empty() ? nullptr : chunk.normals.data(),
            chunk.positions.size() / 3, chunk.indices.data(), chunk.indices.size());
  }
  out.sort();
  return out;
}

}  // namespace mc::test
