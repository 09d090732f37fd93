// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "extract/cubes/edge_vertex.hpp"
#include "mc/mesh.hpp"

// Figures of the surface that are gathered while it is made.

namespace mc::extraction {

/// Area and volume of the surface in one layer of cells. Summed a layer at a time, so that the
/// total does not depend on how layers were dealt to threads.
struct LayerSum {
  double area = 0;
  double volume = 0;
};

/// What one task found.
struct TaskTotals {
  std::uint64_t n_vertices = 0;
  std::uint64_t n_triangles = 0;
  std::uint64_t n_boundary_edges = 0;
  Bounds bounds;
  std::vector<LayerSum> layers;  ///< only when measured
  std::uint64_t n_asked = 0, n_skipped = 0;
  std::uint64_t n_materials_held = 0;

  /// Adds what a piece of the task found; vertices have been counted.
  void add_piece(const TaskTotals& piece) {
    n_triangles += piece.n_triangles;
    n_boundary_edges += piece.n_boundary_edges;
    n_materials_held += piece.n_materials_held;
    bounds.include(piece.bounds);
    layers.insert(layers.end(), piece.layers.begin(), piece.layers.end());
  }
  void clear() {
    layers.clear();
    *this = {0, 0, 0, {}, std::move(layers)};
  }
};

/// The middle of a box of samples, in lattice units.
inline Vec3 middle_of(const IndexBox& box) {
  Vec3 middle;
  for (std::size_t a = 0; a < 3; ++a) {
    middle[a] = 0.5 * (static_cast<double>(box.lo[a]) + static_cast<double>(box.hi[a]));
  }
  return middle;
}

/// Adds one cell's triangles, their cones taken from `apex`, a place of the lattice.
template <class T, class Sampler>
void add_cell(const EdgeVertices<T, Sampler>& vertices, const Placement& placement,
              const Index3& cell, const CaseRow& row, const Vec3& apex, LayerSum& sum) {
  const Vec3 to_cell = placement.linear({static_cast<double>(cell[0]) - apex[0],
                                         static_cast<double>(cell[1]) - apex[1],
                                         static_cast<double>(cell[2]) - apex[2]});
  for (std::size_t t = 0; t < row.n_triangles; ++t) {
    Vec3 p{};
    const Vec3 a = vertices.area_vector(cell, row, t, &p);
    sum.area += std::sqrt((a[0] * a[0] + a[1] * a[1]) + a[2] * a[2]);
    sum.volume +=
        (((p[0] + to_cell[0]) * a[0] + (p[1] + to_cell[1]) * a[1]) + (p[2] + to_cell[2]) * a[2]) /
        3;
  }
}

}  // namespace mc::extraction
