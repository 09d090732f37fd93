// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

// The 256 cases of marching cubes, computed at compile time from one rule for a cell's face.
//
//         6 ---3--- 7            corner c lies at (c & 1, c >> 1 & 1, c >> 2 & 1);
//        /|        /|            bit c of a case is set where corner c is above.
//       6 |       7 |
//      /  10     /  11           edges 0..3 run along i, 4..7 along j, 8..11 along k, each ordered
//     4 ---2--- 5   |            by its lower corner: the low bit is the nearer axis.
//     |   |     |   |
//     |   2 --1-|-- 3
//     8  /      9  /             k
//     | 4       | 5              | / j
//     |/        |/               |/
//     0 ---0--- 1                +--- i
//
// On each face the crossed edges are joined by segments: two crossings by one, four crossings by
// two that cut off each above corner by itself. Both cells of a face see the same segments, so no
// hole can open, which is the fault of the 15 cases of Lorensen and Cline (1987). The segments
// chain to loops, and each loop is fanned from its first edge for which no diagonal joins two edges
// of one face: such a diagonal could be used by the neighbour too, and make an edge of four
// triangles.

namespace mc::extraction {

inline constexpr int kCorners = 8;
inline constexpr int kEdges = 12;
inline constexpr int kMaxTriangles = 5;

/// The triangles of one case as edges, three each, wound so that normals point from above to below.
struct CaseRow {
  std::uint8_t n_triangles = 0;
  std::array<std::uint8_t, 3 * kMaxTriangles> edges{};
};

/// The lower corner of an edge, and the axis along which it runs.
struct EdgeEnds {
  int corner;
  int axis;
};
constexpr EdgeEnds edge_ends(int edge) {
  const int axis = edge / 4;
  const int n = edge % 4;
  switch (axis) {
    case 0:
      return {n << 1, 0};
    case 1:
      return {(n & 1) | ((n >> 1) << 2), 1};
    default:
      return {n, 2};
  }
}

/// The edge at place n of a row's triangles, or of its triangles turned round.
constexpr std::uint8_t edge_at(const CaseRow& row, std::size_t n, bool flip) {
  return row.edges[flip && n % 3 != 0 ? n + 3 - 2 * (n % 3) : n];
}

/// Row n holds case n; computed by the compiler.
extern const std::array<CaseRow, 256> kCases;

}  // namespace mc::extraction
