// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mc/base.hpp"

namespace mc::process {

/// A mesh whose edges collapse, with the rules that say which ones may.
///
/// Triangle t has corners 4 t to 4 t + 2. The corners of each vertex form a list in no particular
/// order; those of triangles that are gone leave it when it is next walked.
class CollapseMesh {
 public:
  /// Positions in cells and normals of vertices, of which the first `n_seam` are the seam.
  CollapseMesh(std::vector<Vec3> positions, std::vector<std::array<float, 3>> normals,
               std::span<const std::uint32_t> indices, std::size_t n_seam);

  [[nodiscard]] std::size_t n_vertices() const { return positions_.size(); }
  /// Triangles that are left.
  [[nodiscard]] std::size_t n_triangles() const { return n_triangles_; }
  /// All triangles, those that are gone included.
  [[nodiscard]] std::size_t n_all_triangles() const { return corners_.size() / 4; }
  [[nodiscard]] bool is_gone(std::size_t triangle) const { return corners_[4 * triangle + 3] != 0; }
  [[nodiscard]] const std::uint32_t* triangle(std::size_t n) const { return &corners_[4 * n]; }
  [[nodiscard]] const Vec3& position(std::uint32_t vertex) const { return positions_[vertex]; }

  /// Whether a vertex may collapse onto another: it is not on the seam, and its triangles form one
  /// closed fan.
  [[nodiscard]] bool is_free(std::uint32_t vertex) const { return kinds_[vertex] == Kind::free; }

  /// Whether the mesh stays manifold, with its components and Euler number, if `a`, which is free,
  /// collapses onto its neighbour `b`. The rules:
  ///   - a and b have exactly two common neighbours (the link condition);
  ///   - neither of these has so few triangles that two triangles with the same vertices would be
  ///     left: three, or on the seam, where it has more in other cubes, two;
  ///   - if b is on the seam, no vertex of the seam becomes its neighbour, as there may be an edge
  ///     between them in another cube.
  [[nodiscard]] bool keeps_topology(std::uint32_t a, std::uint32_t b);
  /// Whether no triangle degenerates, turns by more than 75 degrees, or comes to face against the
  /// normal of a corner.
  [[nodiscard]] bool keeps_shape(std::uint32_t a, std::uint32_t b);
  /// Moves a onto b. Preconditions: a is free, keeps_topology().
  void collapse(std::uint32_t a, std::uint32_t b);

  /// Calls visit(corner) for each corner of a vertex.
  template <class Visit>
  void for_corners(std::uint32_t vertex, Visit&& visit) {
    for (std::uint32_t* link = &heads_[vertex]; *link != kEnd;) {
      const std::uint32_t corner = *link;
      if (corners_[corner | 3U] != 0) {
        *link = next_of_vertex_[corner];
        continue;
      }
      visit(corner);
      link = &next_of_vertex_[corner];
    }
  }
  /// The vertex after that of a corner, and the one before, around the triangle.
  [[nodiscard]] std::uint32_t after(std::uint32_t corner) const {
    return corners_[(corner & 3U) == 2 ? corner - 2 : corner + 1];
  }
  [[nodiscard]] std::uint32_t before(std::uint32_t corner) const {
    return corners_[(corner & 3U) == 0 ? corner + 2 : corner - 1];
  }

 private:
  enum class Kind : std::uint8_t { free, border, seam };
  static constexpr std::uint32_t kEnd = 0xFFFFFFFF;

  [[nodiscard]] bool has_closed_fan(std::uint32_t vertex);
  [[nodiscard]] bool would_fold(std::uint32_t neighbour) const;
  [[nodiscard]] bool keeps_shape_of(std::uint32_t corner, std::uint32_t b) const;

  std::vector<Vec3> positions_;
  std::vector<std::array<float, 3>> normals_;
  std::vector<std::uint32_t> corners_;  ///< vertices; every fourth: 1 if the triangle is gone
  std::vector<std::uint32_t> next_of_vertex_;  ///< next corner of the same vertex
  std::vector<std::uint32_t> heads_;           ///< first corner of each vertex
  std::vector<std::uint32_t> n_triangles_of_;  ///< at each vertex
  std::vector<std::uint32_t> marks_;
  std::vector<Kind> kinds_;
  std::uint32_t mark_ = 0;  ///< the latest
  std::size_t n_triangles_;
};

}  // namespace mc::process
