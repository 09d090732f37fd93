// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

// Normals of triangles by themselves; compiled for every SIMD target.

namespace mc::mesh {

/// Triangles that are computed together: a multiple of the doubles in any vector.
constexpr std::size_t kFacetBlock = 64;

/// Coordinate a of corner c of triangle n is corner[3 * c + a][n].
struct FacetBlock {
  alignas(64) float corner[9][kFacetBlock];
  alignas(64) float normal[3][kFacetBlock];
};

/// Fills in the unit normals by the right hand: computed in double and rounded once, never -0; zero
/// where a triangle has no area or is not finite.
void compute_normals(FacetBlock& block);

}  // namespace mc::mesh
