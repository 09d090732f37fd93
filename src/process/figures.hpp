// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "mc/process.hpp"
#include "process/exact_sum.hpp"

// Figures of a mesh after its stages. Each triangle and each edge belongs to one window, and sums
// are exact, so that figures do not depend on how the mesh is cut into windows.

namespace mc::process {

/// Area and volume of triangles.
struct SurfaceSums {
  ExactSum area;    ///< square world units
  ExactSum volume;  ///< cubic world units: of the cones from one fixed point to the triangles

  void add(const SurfaceSums& other) {
    area.add(other.area);
    volume.add(other.volume);
  }
};

/// Bounds of all vertices of a chunk, relative to the origin.
Bounds bounds_of(const MeshChunk& mesh);

/// Sums over the own triangles, with the tips of the cones at `apex`, relative to the origin.
SurfaceSums own_sums(const MeshWindow& window, const Vec3& apex);

/// Edges of one triangle, of those whose first vertex is the window's own.
/// Cost     O(window log fan) time, kEdgeVertexBytes and kEdgeTriangleBytes of scratch.
std::uint64_t own_boundary_edges(const MeshWindow& window);
inline constexpr std::uint64_t kEdgeVertexBytes = 8;
inline constexpr std::uint64_t kEdgeTriangleBytes = 12;

}  // namespace mc::process
