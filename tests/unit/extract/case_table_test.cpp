// SPDX-License-Identifier: MIT
#include "extract/cubes/case_table.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <tuple>
#include <vector>

namespace mc::extraction {
namespace {

/// A lattice edge of a group of cells: lower corner and axis.
using Edge = std::array<int, 4>;
using Side = std::pair<Edge, Edge>;

Edge edge_in(std::array<int, 3> cell, CellEdge edge) {
  const Index3 lower = edge.lower().of(cell);
  return {lower[0], lower[1], lower[2], static_cast<int>(edge.axis())};
}

void add_sides(std::map<Side, int>& sides, std::array<int, 3> cell, unsigned cell_case) {
  const CaseRow& row = kCases[cell_case];
  for (std::size_t t = 0; t < row.n_triangles; ++t) {
    for (std::size_t n = 0; n < 3; ++n) {
      const CellEdge a = row.edges[3 * t + n];
      const CellEdge b = row.edges[3 * t + (n + 1) % 3];
      ++sides[{edge_in(cell, a), edge_in(cell, b)}];
    }
  }
}

/// Whether both edges lie in one face of the box [0, extent].
bool in_outer_face(const Side& side, std::array<int, 3> extent) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (side.first[3] == static_cast<int>(a) || side.second[3] == static_cast<int>(a)) continue;
    if (side.first[a] == side.second[a] && (side.first[a] == 0 || side.first[a] == extent[a])) {
      return true;
    }
  }
  return false;
}

void expect_sides_paired(const std::map<Side, int>& sides, std::array<int, 3> extent) {
  for (const auto& [side, n] : sides) {
    ASSERT_EQ(n, 1);
    const auto opposite = sides.find({side.second, side.first});
    if (in_outer_face(side, extent)) {
      ASSERT_EQ(opposite, sides.end());
    } else {
      ASSERT_NE(opposite, sides.end());
    }
  }
}

TEST(CaseTable, EdgesAreNumberedByAxisThenByLowerCorner) {
  std::vector<std::array<std::size_t, 3>> edges;
  for (std::size_t e = 0; e < kEdges; ++e) {
    const CellEdge edge(e);
    edges.push_back({edge.axis(), edge.lower(), edge.upper()});
  }
  const std::vector<std::array<std::size_t, 3>> expected{
      {0, 0, 1}, {0, 2, 3}, {0, 4, 5}, {0, 6, 7}, {1, 0, 2}, {1, 1, 3},
      {1, 4, 6}, {1, 5, 7}, {2, 0, 4}, {2, 1, 5}, {2, 2, 6}, {2, 3, 7}};
  EXPECT_EQ(edges, expected);
}

TEST(CaseTable, OneCornerGivesOneTriangleThatLooksAway) {
  ASSERT_EQ(kCases[1].n_triangles, 1);
  EXPECT_EQ(kCases[1].edges[0], 0U);
  EXPECT_EQ(kCases[1].edges[1], 4U);
  EXPECT_EQ(kCases[1].edges[2], 8U);
}

TEST(CaseTable, All256CasesUseEveryInnerSideOnceEachWay) {
  for (unsigned c = 0; c < 256; ++c) {
    std::map<Side, int> sides;
    add_sides(sides, {0, 0, 0}, c);
    expect_sides_paired(sides, {1, 1, 1});
  }
}

TEST(CaseTable, EveryCrossedEdgeIsUsedAndNoOther) {
  for (unsigned c = 0; c < 256; ++c) {
    std::set<std::size_t> used;
    for (std::size_t n = 0; n < 3U * kCases[c].n_triangles; ++n) used.insert(kCases[c].edges[n]);
    for (std::size_t e = 0; e < kEdges; ++e) {
      const CellEdge edge(e);
      const bool crossed = ((c >> edge.lower()) & 1U) != ((c >> edge.upper()) & 1U);
      EXPECT_EQ(used.contains(e), crossed) << c << " " << e;
    }
  }
}

// Two cells that share a face: 12 corners, three directions, 12,288 in all.
TEST(CaseTable, AllTwoCellNeighbourhoodsUseEveryInnerSideOnceEachWay) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<int, 3> extent{1, 1, 1};
    extent[axis] = 2;
    for (unsigned bits = 0; bits < 4096; ++bits) {
      const auto above = [&](std::array<int, 3> p) {
        const std::size_t u = (axis + 1) % 3;
        const std::size_t v = (axis + 2) % 3;
        return bits >> (p[axis] * 4 + p[u] * 2 + p[v]) & 1U;
      };
      std::map<Side, int> sides;
      for (int n = 0; n < 2; ++n) {
        std::array<int, 3> cell{0, 0, 0};
        cell[axis] = n;
        unsigned cell_case = 0;
        for (int c = 0; c < 8; ++c) {
          cell_case |= above({cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2)}) << c;
        }
        add_sides(sides, cell, cell_case);
      }
      expect_sides_paired(sides, extent);
    }
  }
}

}  // namespace
}  // namespace mc::extraction
