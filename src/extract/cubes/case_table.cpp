// SPDX-License-Identifier: MIT
#include "extract/cubes/case_table.hpp"

#include <cassert>

// Builds the case table from the face rule, and has the compiler prove its laws.

namespace mc::extraction {

namespace {

template <class T, std::size_t kN>
constexpr std::array<T, kN> all_of() {
  std::array<T, kN> all{};
  for (std::size_t n = 0; n < kN; ++n) all[n] = T(n);
  return all;
}
constexpr std::array<CellEdge, kEdges> kAllEdges = all_of<CellEdge, kEdges>();

/// A face is the side of `axis` where that coordinate is `side`.
struct Face {
  Axis axis;
  std::int32_t side;
};
constexpr std::array<Face, 6> kFaces{
    {{kAxes[0], 0}, {kAxes[0], 1}, {kAxes[1], 0}, {kAxes[1], 1}, {kAxes[2], 0}, {kAxes[2], 1}}};

constexpr bool corner_on(Face f, Corner corner) { return corner.along(f.axis) == f.side; }
constexpr bool edge_on(Face f, CellEdge edge) {
  return edge.axis() != f.axis && corner_on(f, edge.lower());
}

constexpr bool share_face(CellEdge a, CellEdge b) {
  for (const Face& f : kFaces) {
    if (edge_on(f, a) && edge_on(f, b)) return true;
  }
  return false;
}

/// Twice the corner's position, and twice the edge's midpoint.
constexpr Index3 corner_at(Corner c) {
  return {2 * c.along(kAxes[0]), 2 * c.along(kAxes[1]), 2 * c.along(kAxes[2])};
}
constexpr Index3 middle_of(CellEdge edge) {
  Index3 p = corner_at(edge.lower());
  p[edge.axis()] += 1;
  return p;
}
constexpr Index3 minus(Index3 a, Index3 b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
constexpr Index3 cross(Index3 a, Index3 b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
constexpr std::int32_t dot(Index3 a, Index3 b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Whether the segment a -> b on face f has the above corner on its right, seen from outside.
constexpr bool directed(Face f, CellEdge a, CellEdge b, Corner above) {
  Index3 normal{0, 0, 0};
  normal[f.axis] = f.side == 1 ? 1 : -1;
  const Index3 left = cross(normal, minus(middle_of(b), middle_of(a)));
  return dot(left, minus(corner_at(above), middle_of(a))) < 0;
}

/// Edges in the order in which they are found.
template <std::size_t kRoom>
struct EdgeRun {
  std::array<CellEdge, kRoom> edges{};
  std::size_t size = 0;

  constexpr void add(CellEdge edge) { edges[size++] = edge; }
  /// The nth edge round the loop.
  [[nodiscard]] constexpr CellEdge at(std::size_t n) const {
    assert(size != 0);
    return edges[n % size];
  }
};
using Loop = EdgeRun<kEdges>;

/// Where the loops go from each crossed edge.
struct Successors {
  std::array<CellEdge, kEdges> next{};
  std::array<bool, kEdges> known{};

  /// Joins two edges of a face, in the direction that the above corner gives.
  constexpr void join(Face f, CellEdge a, CellEdge b, Corner above) {
    const bool forward = directed(f, a, b, above);
    const CellEdge from = forward ? a : b;
    next[from] = forward ? b : a;
    known[from] = true;
  }
  /// The loop through an edge that has a successor.
  [[nodiscard]] constexpr Loop loop_from(CellEdge first) const {
    Loop loop;
    CellEdge e = first;
    do {
      loop.add(e);
      e = next[e];
    } while (e != first);
    return loop;
  }
};

/// The one rule: joins the crossed edges of face `f`.
constexpr void join_face(Successors& successors, Face f, CellCase cell_case) {
  EdgeRun<4> crossed;
  for (const CellEdge e : kAllEdges) {
    if (edge_on(f, e) && cell_case.crosses(e)) crossed.add(e);
  }
  for (std::size_t n = 0; n < kCorners; ++n) {
    const Corner corner(n);
    if (!corner_on(f, corner) || !cell_case.above(corner)) continue;
    if (crossed.size == 2) {
      return successors.join(f, crossed.at(0), crossed.at(1), corner);
    }
    if (crossed.size == 4) {  // cut this corner off: join its own two edges
      EdgeRun<2> own;
      for (const CellEdge e : crossed.edges) {
        if (e.lower() == corner || e.upper() == corner) own.add(e);
      }
      successors.join(f, own.at(0), own.at(1), corner);
    }
  }
}

constexpr Successors successors_of(CellCase cell_case) {
  Successors successors;
  for (const Face& f : kFaces) join_face(successors, f, cell_case);
  return successors;
}

/// Whether a fan from the loop's edge `start` has a diagonal within a face.
constexpr bool fan_touches_face(const Loop& loop, std::size_t start) {
  for (std::size_t n = 2; n + 1 < loop.size; ++n) {
    if (share_face(loop.at(start), loop.at(start + n))) return true;
  }
  return false;
}

/// The start with the lowest edge number whose fan keeps off the faces; the loop's size if there is
/// none.
constexpr std::size_t fan_start(const Loop& loop) {
  std::size_t best = loop.size;
  for (std::size_t s = 0; s < loop.size; ++s) {
    if (!fan_touches_face(loop, s) && (best == loop.size || loop.at(s) < loop.at(best))) best = s;
  }
  return best;
}

constexpr CaseRow row_of(CellCase cell_case) {
  const Successors successors = successors_of(cell_case);
  CaseRow row;
  std::array<bool, kEdges> done{};
  for (const CellEdge first : kAllEdges) {
    if (!successors.known[first] || done[first]) continue;
    const Loop loop = successors.loop_from(first);
    for (std::size_t n = 0; n < loop.size; ++n) done[loop.at(n)] = true;
    const std::size_t start = fan_start(loop);
    for (std::size_t n = 1; n + 1 < loop.size; ++n) {
      const std::size_t at = 3U * row.n_triangles++;
      row.edges[at] = loop.at(start);
      row.edges[at + 1] = loop.at(start + n);
      row.edges[at + 2] = loop.at(start + n + 1);
    }
  }
  return row;
}

constexpr std::array<CaseRow, 256> all_rows() {
  std::array<CaseRow, 256> rows{};
  for (std::size_t c = 0; c < rows.size(); ++c) rows[c] = row_of(CellCase(c));
  return rows;
}

/// Every crossed edge, and no other, has exactly one successor and follows one edge.
constexpr bool loops_are_whole(const Successors& successors, CellCase cell_case) {
  std::array<int, kEdges> entered{};
  for (const CellEdge e : kAllEdges) {
    if (successors.known[e] != cell_case.crosses(e)) return false;
    if (successors.known[e]) ++entered[successors.next[e]];
  }
  for (const CellEdge e : kAllEdges) {
    if (entered[e] != (cell_case.crosses(e) ? 1 : 0)) return false;
  }
  return true;
}

/// Loops are whole, of three edges or more, and can be fanned.
constexpr bool laws_hold() {
  for (std::size_t c = 0; c < 256; ++c) {
    const Successors successors = successors_of(CellCase(c));
    if (!loops_are_whole(successors, CellCase(c))) return false;
    for (const CellEdge first : kAllEdges) {
      if (!successors.known[first]) continue;
      const Loop loop = successors.loop_from(first);
      if (loop.size < 3 || fan_start(loop) == loop.size) return false;
    }
  }
  return true;
}

static_assert(laws_hold());

constexpr std::array<CaseRow, 256> kComputed = all_rows();
static_assert(kComputed[0].n_triangles == 0 && kComputed[255].n_triangles == 0);
static_assert(sizeof(CaseRow) == 16);

}  // namespace

constinit const std::array<CaseRow, 256> kCases = kComputed;

}  // namespace mc::extraction
