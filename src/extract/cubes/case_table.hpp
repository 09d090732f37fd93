// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "extract/bits/cell.hpp"

// The 256 cases of marching cubes, computed at compile time from one rule for a cell's face.
// Corners and edges are numbered as bits/cell.hpp draws them.
//
// On each face the crossed edges are joined by segments: two crossings by one, four crossings by
// two that cut off each above corner by itself. Both cells of a face see the same segments, so no
// hole can open, which is the fault of the 15 cases of Lorensen and Cline (1987). The segments
// chain to loops, and each loop is fanned from its first edge for which no diagonal joins two edges
// of one face: such a diagonal could be used by the neighbour too, and make an edge of four
// triangles.

namespace mc::extraction {

inline constexpr std::size_t kMaxTriangles = 5;

/// The triangles of one case as edges, three each, wound so that normals point from above to below.
struct CaseRow {
  std::uint8_t n_triangles = 0;
  std::array<CellEdge, 3 * kMaxTriangles> edges{};
};

/// The edge at place n of a row's triangles, or of its triangles turned round.
constexpr CellEdge edge_at(const CaseRow& row, std::size_t n, bool flip) {
  return row.edges[flip && n % 3 != 0 ? n + 3 - 2 * (n % 3) : n];
}

/// Indexed by CellCase; computed by the compiler.
extern const std::array<CaseRow, 256> kCases;

}  // namespace mc::extraction
