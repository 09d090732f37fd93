// SPDX-License-Identifier: MIT
#include "extract/cubes/case_table.hpp"

// Builds the case table from the face rule, and has the compiler prove its laws.

namespace mc::extraction {

namespace {

constexpr bool edge_crossed(int cell_case, int edge) {
  const EdgeEnds e = edge_ends(edge);
  return ((cell_case >> e.corner) & 1) != ((cell_case >> (e.corner | (1 << e.axis))) & 1);
}

/// A face is the side of `axis` where that coordinate is `side`.
struct Face {
  int axis;
  int side;
};
constexpr Face face_of(int n) { return {n / 2, n % 2}; }

constexpr bool corner_on(Face f, int corner) { return ((corner >> f.axis) & 1) == f.side; }
constexpr bool edge_on(Face f, int edge) {
  const EdgeEnds e = edge_ends(edge);
  return e.axis != f.axis && corner_on(f, e.corner);
}

constexpr bool share_face(int edge_a, int edge_b) {
  for (int n = 0; n < 6; ++n) {
    if (edge_on(face_of(n), edge_a) && edge_on(face_of(n), edge_b)) {
      return true;
    }
  }
  return false;
}

using Int3 = std::array<int, 3>;

/// Twice the corner's position, and twice the edge's midpoint.
constexpr Int3 corner_at(int c) { return {2 * (c & 1), 2 * ((c >> 1) & 1), 2 * ((c >> 2) & 1)}; }
constexpr Int3 middle_of(int edge) {
  const EdgeEnds e = edge_ends(edge);
  Int3 p = corner_at(e.corner);
  p[static_cast<std::size_t>(e.axis)] += 1;
  return p;
}
constexpr Int3 minus(Int3 a, Int3 b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
constexpr Int3 cross(Int3 a, Int3 b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
constexpr int dot(Int3 a, Int3 b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Whether the segment a -> b on face f has the above corner on its right, seen from outside.
constexpr bool directed(Face f, int a, int b, int above_corner) {
  Int3 normal{0, 0, 0};
  normal[static_cast<std::size_t>(f.axis)] = f.side == 1 ? 1 : -1;
  const Int3 left = cross(normal, minus(middle_of(b), middle_of(a)));
  return dot(left, minus(corner_at(above_corner), middle_of(a))) < 0;
}

/// Where the loop goes from each crossed edge; -1 for edges that are not crossed.
using Successors = std::array<int, kEdges>;

constexpr void join(Successors& next, Face f, int a, int b, int above_corner) {
  if (directed(f, a, b, above_corner)) {
    next[static_cast<std::size_t>(a)] = b;
  } else {
    next[static_cast<std::size_t>(b)] = a;
  }
}

/// The one rule: joins the crossed edges of face `f`.
constexpr void join_face(Successors& next, Face f, int cell_case) {
  std::array<int, 4> crossed{};
  int n_crossed = 0;
  for (int e = 0; e < kEdges; ++e) {
    if (edge_on(f, e) && edge_crossed(cell_case, e)) {
      crossed[static_cast<std::size_t>(n_crossed++)] = e;
    }
  }
  for (int c = 0; c < kCorners; ++c) {
    if (!corner_on(f, c) || ((cell_case >> c) & 1) == 0) {
      continue;
    }
    if (n_crossed == 2) {
      join(next, f, crossed[0], crossed[1], c);
      return;
    }
    if (n_crossed == 4) {  // cut this corner off: join its own two edges
      std::array<int, 2> own{};
      int n = 0;
      for (const int e : crossed) {
        const EdgeEnds ends = edge_ends(e);
        if (ends.corner == c || (ends.corner | (1 << ends.axis)) == c) {
          own[static_cast<std::size_t>(n++)] = e;
        }
      }
      join(next, f, own[0], own[1], c);
    }
  }
}

struct Loop {
  std::array<int, kEdges> edges{};
  int size = 0;

  [[nodiscard]] constexpr int at(int n) const { return edges[static_cast<std::size_t>(n % size)]; }
};

/// Whether a fan from edges[start] has a diagonal within a face.
constexpr bool fan_touches_face(const Loop& loop, int start) {
  for (int n = 2; n + 1 < loop.size; ++n) {
    if (share_face(loop.at(start), loop.at(start + n))) {
      return true;
    }
  }
  return false;
}

/// The start with the lowest edge number whose fan keeps off the faces; -1 where there is none.
constexpr int fan_start(const Loop& loop) {
  int best = -1;
  for (int s = 0; s < loop.size; ++s) {
    if (!fan_touches_face(loop, s) && (best < 0 || loop.at(s) < loop.at(best))) {
      best = s;
    }
  }
  return best;
}

constexpr CaseRow case_row(int cell_case) {
  Successors next{};
  next.fill(-1);
  for (int f = 0; f < 6; ++f) {
    join_face(next, face_of(f), cell_case);
  }
  CaseRow row;
  std::array<bool, kEdges> done{};
  for (int first = 0; first < kEdges; ++first) {
    if (next[static_cast<std::size_t>(first)] < 0 || done[static_cast<std::size_t>(first)]) {
      continue;
    }
    Loop loop;
    for (int e = first; !done[static_cast<std::size_t>(e)]; e = next[static_cast<std::size_t>(e)]) {
      done[static_cast<std::size_t>(e)] = true;
      loop.edges[static_cast<std::size_t>(loop.size++)] = e;
    }
    const int start = fan_start(loop);
    for (int n = 1; n + 1 < loop.size; ++n) {
      const auto at = static_cast<std::size_t>(3 * row.n_triangles++);
      row.edges[at] = static_cast<std::uint8_t>(loop.at(start));
      row.edges[at + 1] = static_cast<std::uint8_t>(loop.at(start + n));
      row.edges[at + 2] = static_cast<std::uint8_t>(loop.at(start + n + 1));
    }
  }
  return row;
}

constexpr std::array<CaseRow, 256> all_cases() {
  std::array<CaseRow, 256> rows{};
  for (int c = 0; c < 256; ++c) {
    rows[static_cast<std::size_t>(c)] = case_row(c);
  }
  return rows;
}

/// Every crossed edge, and no other, has exactly one successor, and every loop a start.
constexpr bool laws_hold() {
  for (int c = 0; c < 256; ++c) {
    Successors next{};
    next.fill(-1);
    for (int f = 0; f < 6; ++f) {
      join_face(next, face_of(f), c);
    }
    std::array<int, kEdges> entered{};
    for (int e = 0; e < kEdges; ++e) {
      if ((next[static_cast<std::size_t>(e)] >= 0) != edge_crossed(c, e)) {
        return false;
      }
      if (next[static_cast<std::size_t>(e)] >= 0) {
        ++entered[static_cast<std::size_t>(next[static_cast<std::size_t>(e)])];
      }
    }
    for (int e = 0; e < kEdges; ++e) {
      if (entered[static_cast<std::size_t>(e)] != (edge_crossed(c, e) ? 1 : 0)) {
        return false;
      }
    }
    for (int first = 0; first < kEdges; ++first) {
      if (next[static_cast<std::size_t>(first)] < 0) {
        continue;
      }
      Loop loop;
      int e = first;
      do {
        loop.edges[static_cast<std::size_t>(loop.size++)] = e;
        e = next[static_cast<std::size_t>(e)];
      } while (e != first);
      if (loop.size < 3 || fan_start(loop) < 0) {
        return false;
      }
    }
  }
  return true;
}

static_assert(laws_hold());

constexpr std::array<CaseRow, 256> kComputed = all_cases();
static_assert(kComputed[0].n_triangles == 0 && kComputed[255].n_triangles == 0);
static_assert(sizeof(CaseRow) == 16);

}  // namespace

constinit const std::array<CaseRow, 256> kCases = kComputed;

}  // namespace mc::extraction
