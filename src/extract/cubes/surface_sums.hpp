// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>

#include "extract/cubes/edge_vertex.hpp"
#include "mc/method.hpp"

// Figures of the surface that are gathered while it is made.

namespace mc::extraction {

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
