// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "mc/mesh.hpp"
#include "mesh/position_index.hpp"

// Counts what is wrong with a mesh. All that can be said of edges, fans and duplicates is seen from
// a single vertex: its triangles are gathered (a counting sort over corners), and every vertex is
// then judged by itself, in parallel. An edge belongs to its lower vertex, a triangle to its
// lowest. Triangles with an index out of range or a repeated vertex are no triangles to topology
// and take no part in it. Sums of floating-point numbers are made block by block and added in
// order, so that no figure depends on the thread count. Arithmetic is in double precision and on
// 64-bit ids; positions and triangles are read in the width in which the mesh stores them.

namespace mc {

namespace {

constexpr std::size_t kBlock = std::size_t{1} << 15;  // vertices or triangles, one item of work

template <class T>
using Positions = std::span<const std::array<T, 3>>;
template <class VertexId>
using Triangle = std::array<VertexId, 3>;
template <class VertexId>
using Triangles = std::span<const Triangle<VertexId>>;

template <class T>
Vec3 at(Positions<T> positions, std::size_t vertex) {
  const std::array<T, 3>& p = positions[vertex];
  return {double{p[0]}, double{p[1]}, double{p[2]}};
}

bool finite(const Vec3& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

template <class VertexId>
bool in_range(const Triangle<VertexId>& t, std::size_t n_vertices) {
  return t[0] < n_vertices && t[1] < n_vertices && t[2] < n_vertices;
}

template <class VertexId>
bool repeats_vertex(const Triangle<VertexId>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// Scales by the power of two that brings the largest component to [1/2, 1).
void normalise(Vec3& v) {
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  int exponent = 0;
  std::frexp(largest, &exponent);
  for (double& x : v) {
    x = std::ldexp(x, -exponent);
  }
}

/// a * b == c * d without rounding: equal products round to the same number and leave the same
/// rest.
bool equal_products(double a, double b, double c, double d) {
  const double ab = a * b;
  const double cd = c * d;
  return ab == cd && std::fma(a, b, -ab) == std::fma(c, d, -cd);
}

/// Whether p, q, r (finite) lie on one line, where rounding or range could hide the answer.
bool collinear_exactly(const Vec3& p, const Vec3& q, const Vec3& r) {
  const bool huge = !finite(minus(q, p)) || !finite(minus(r, p));
  Vec3 a = huge ? minus(scaled(q, 0.25), scaled(p, 0.25)) : minus(q, p);
  Vec3 b = huge ? minus(scaled(r, 0.25), scaled(p, 0.25)) : minus(r, p);
  normalise(a);
  normalise(b);
  return equal_products(a[1], b[2], a[2], b[1]) && equal_products(a[2], b[0], a[0], b[2]) &&
         equal_products(a[0], b[1], a[1], b[0]);
}

bool has_zero_area(const Vec3& p, const Vec3& q, const Vec3& r) {
  const Vec3 normal = cross(minus(q, p), minus(r, p));
  const auto surely_not_zero = [](double x) { return x != 0 && std::isfinite(x); };
  if (std::ranges::any_of(normal, surely_not_zero)) {
    return false;
  }
  return collinear_exactly(p, q, r);
}

/// Calls body(block, begin, end) for the blocks of [0, n); returns nothing, blocks keep results.
template <class Body>
void for_blocks(std::size_t n, const Body& body) {
  const std::size_t n_blocks = (n + kBlock - 1) / kBlock;
  base::for_ranges(n_blocks, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t block = first; block < last; ++block) {
      body(block, block * kBlock, std::min(n, (block + 1) * kBlock));
    }
  });
}

std::size_t block_count(std::size_t n) { return (n + kBlock - 1) / kBlock; }

template <class T>
void measure_vertices(Positions<T> positions, std::span<const std::array<float, 3>> normals,
                      MeshReport& report) {
  const bool has_normals = normals.size() == positions.size();
  mesh::PositionIndex known;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const Vec3 p = at(positions, v);
    const bool good_normal =
        !has_normals || (std::isfinite(normals[v][0]) && std::isfinite(normals[v][1]) &&
                         std::isfinite(normals[v][2]));
    if (!finite(p) || !good_normal) {
      ++report.not_finite;
    }
    if (finite(p)) {
      report.bounds.include(p);
      report.duplicate_vertices += known.first(positions, v) != v ? 1 : 0;
    }
  }
}

/// What a block of triangles adds up to.
struct Measure {
  std::uint64_t out_of_range = 0, degenerate = 0, proper = 0;
  double area = 0, volume = 0;

  void add(const Measure& other) {
    out_of_range += other.out_of_range;
    degenerate += other.degenerate;
    proper += other.proper;
    area += other.area;
    volume += other.volume;
  }
};

template <class T, class VertexId>
Measure measure(Positions<T> positions, Triangles<VertexId> triangles, const Vec3& centre) {
  Measure sum;
  for (const Triangle<VertexId>& t : triangles) {
    if (!in_range(t, positions.size())) {
      ++sum.out_of_range;
      continue;
    }
    if (repeats_vertex(t)) {
      ++sum.degenerate;
      continue;
    }
    ++sum.proper;
    const Vec3 p = at(positions, t[0]);
    const Vec3 q = at(positions, t[1]);
    const Vec3 r = at(positions, t[2]);
    if (!finite(p) || !finite(q) || !finite(r)) {
      continue;
    }
    sum.degenerate += has_zero_area(p, q, r) ? 1 : 0;
    const Vec3 normal = cross(minus(q, p), minus(r, p));
    sum.area += length(normal) / 2;
    sum.volume += dot(minus(p, centre), normal) / 6;
  }
  return sum;
}

template <class T, class VertexId>
Measure measure_triangles(Positions<T> positions, Triangles<VertexId> triangles,
                          const Bounds& bounds) {
  Vec3 centre{};
  if (!bounds.empty()) {
    for (std::size_t a = 0; a < 3; ++a) {
      centre[a] = bounds.lo[a] / 2 + bounds.hi[a] / 2;
    }
  }
  std::vector<Measure> blocks(block_count(triangles.size()));
  for_blocks(triangles.size(), [&](std::size_t block, std::size_t begin, std::size_t end) {
    blocks[block] = measure(positions, triangles.subspan(begin, end - begin), centre);
  });
  Measure sum;
  for (const Measure& block : blocks) {
    sum.add(block);
  }
  return sum;
}

/// Triangles of each vertex: those of v are of[start[v]] to of[start[v + 1]]. Id is as narrow as
/// three corners a triangle allow.
template <class Id>
struct Incidence {
  std::vector<Id> start;
  Buffer<Id> of;
};

template <class VertexId>
bool proper(const Triangle<VertexId>& t, std::size_t n_vertices) {
  return in_range(t, n_vertices) && !repeats_vertex(t);
}

template <class Id, class VertexId>
Incidence<Id> gather(Triangles<VertexId> triangles, std::size_t n) {
  Incidence<Id> incidence;
  incidence.start.assign(n + 1, 0);
  for (const Triangle<VertexId>& t : triangles) {
    if (proper(t, n)) {
      for (const VertexId v : t) {
        ++incidence.start[v];
      }
    }
  }
  std::inclusive_scan(incidence.start.begin(), incidence.start.end(), incidence.start.begin());
  incidence.of.resize(incidence.start[n]);
  // Filled from the back, so that each entry ends as the start of its vertex.
  for (std::size_t t = triangles.size(); t-- > 0;) {
    if (proper(triangles[t], n)) {
      for (const VertexId v : triangles[t]) {
        incidence.of[--incidence.start[v]] = static_cast<Id>(t);
      }
    }
  }
  return incidence;
}

/// What a block of vertices sees around itself.
struct Around {
  std::uint64_t referenced = 0, edges = 0, boundary = 0, crowded_edges = 0, misoriented = 0;
  std::uint64_t duplicate = 0, torn = 0;

  void add(const Around& other) {
    referenced += other.referenced;
    edges += other.edges;
    boundary += other.boundary;
    crowded_edges += other.crowded_edges;
    misoriented += other.misoriented;
    duplicate += other.duplicate;
    torn += other.torn;
  }
};

/// Judges one vertex after the other; keeps its scratch.
class VertexJudge {
 public:
  /// `triangle(n)` is the n-th triangle around `v`.
  template <class TriangleAt>
  void judge(std::uint64_t v, std::size_t n_triangles, const TriangleAt& triangle, Around& sum) {
    spokes_.clear();
    opposite_.clear();
    for (std::size_t n = 0; n < n_triangles; ++n) {
      const auto& t = triangle(n);
      const std::size_t corner = t[0] == v ? 0 : t[1] == v ? 1 : 2;
      const std::uint64_t next = t[(corner + 1) % 3];
      const std::uint64_t last = t[(corner + 2) % 3];
      spokes_.push_back({next, n, true});
      spokes_.push_back({last, n, false});
      if (v < next && v < last) {
        opposite_.emplace_back(std::min(next, last), std::max(next, last));
      }
    }
    std::ranges::sort(spokes_, {}, &Spoke::to);
    ++sum.referenced;
    count_edges(v, sum);
    sum.torn += fans(n_triangles) > 1 ? 1 : 0;
    std::ranges::sort(opposite_);
    for (std::size_t n = 1; n < opposite_.size(); ++n) {
      sum.duplicate += opposite_[n] == opposite_[n - 1] ? 1 : 0;
    }
  }

 private:
  /// One triangle's use of the edge from the vertex to `to`.
  struct Spoke {
    std::uint64_t to;
    std::size_t triangle;  // around the vertex
    bool leaves;           // the triangle runs from the vertex to `to`
  };

  void count_edges(std::uint64_t v, Around& sum) const {
    for (std::size_t begin = 0, end = 0; begin < spokes_.size(); begin = end) {
      while (end < spokes_.size() && spokes_[end].to == spokes_[begin].to) {
        ++end;
      }
      if (v < spokes_[begin].to) {
        ++sum.edges;
        sum.boundary += end - begin == 1 ? 1 : 0;
        sum.crowded_edges += end - begin > 2 ? 1 : 0;
        const bool same_way =
            end - begin == 2 && spokes_[begin].leaves == spokes_[begin + 1].leaves;
        sum.misoriented += same_way ? 1 : 0;
      }
    }
  }

  /// Groups of triangles that hang together by edges at the vertex.
  std::size_t fans(std::size_t n_triangles) {
    parent_.resize(n_triangles);
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    const auto root = [this](std::size_t n) {
      while (parent_[n] != n) {
        n = parent_[n] = parent_[parent_[n]];
      }
      return n;
    };
    std::size_t n_fans = n_triangles;
    for (std::size_t s = 1; s < spokes_.size(); ++s) {
      if (spokes_[s].to == spokes_[s - 1].to) {
        const std::size_t a = root(spokes_[s].triangle);
        const std::size_t b = root(spokes_[s - 1].triangle);
        parent_[std::max(a, b)] = std::min(a, b);
        n_fans -= a != b ? 1 : 0;
      }
    }
    return n_fans;
  }

  std::vector<Spoke> spokes_;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> opposite_;
  std::vector<std::size_t> parent_;
};

template <class Id, class VertexId>
Around look_around(Triangles<VertexId> triangles, std::size_t n) {
  const Incidence<Id> incidence = gather<Id>(triangles, n);
  std::vector<Around> blocks(block_count(n));
  for_blocks(n, [&](std::size_t block, std::size_t begin, std::size_t end) {
    VertexJudge judge;
    for (std::size_t v = begin; v < end; ++v) {
      const std::size_t first = incidence.start[v];
      const std::size_t n_around = incidence.start[v + 1] - first;
      const auto triangle = [&](std::size_t k) -> const Triangle<VertexId>& {
        return triangles[incidence.of[first + k]];
      };
      if (n_around > 0) {
        judge.judge(v, n_around, triangle, blocks[block]);
      }
    }
  });
  Around sum;
  for (const Around& block : blocks) {
    sum.add(block);
  }
  return sum;
}

/// Sets of vertices that triangles join, less those that none uses.
template <class Id, class VertexId>
std::uint64_t count_components(Triangles<VertexId> triangles, std::size_t n,
                               std::uint64_t n_referenced) {
  std::vector<Id> parent(n);
  std::iota(parent.begin(), parent.end(), Id{0});
  std::uint64_t n_components = n_referenced;
  for (const Triangle<VertexId>& t : triangles) {
    if (!proper(t, n)) {
      continue;
    }
    for (std::size_t c = 1; c < 3; ++c) {
      const bool joined = base::unite_sets(parent, static_cast<Id>(t[0]), static_cast<Id>(t[c]));
      n_components -= joined ? 1 : 0;
    }
  }
  return n_components;
}

template <class Id, class VertexId>
void check_topology(Triangles<VertexId> triangles, std::uint64_t n_proper, MeshReport& report) {
  const std::size_t n = report.n_vertices;
  const Around around = look_around<Id>(triangles, n);
  report.duplicate = around.duplicate;
  report.boundary_edges = around.boundary;
  report.nonmanifold_edges = around.crowded_edges;
  report.nonmanifold_vertices = around.torn;
  report.misoriented_edges = around.misoriented;
  report.unreferenced_vertices = n - around.referenced;
  report.euler = static_cast<std::int64_t>(around.referenced) -
                 static_cast<std::int64_t>(around.edges) + static_cast<std::int64_t>(n_proper);
  report.components = count_components<Id>(triangles, n, around.referenced);
}

template <class T, class VertexId>
void check(Positions<T> positions, std::span<const std::array<float, 3>> normals,
           Triangles<VertexId> triangles, MeshReport& report) {
  report.n_vertices = positions.size();
  report.n_triangles = triangles.size();
  measure_vertices(positions, normals, report);
  const Measure sum = measure_triangles(positions, triangles, report.bounds);
  report.out_of_range = sum.out_of_range;
  report.degenerate = sum.degenerate;
  report.area = sum.area;
  report.volume = sum.volume;
  constexpr std::uint64_t kNarrow = std::numeric_limits<std::uint32_t>::max();
  if (positions.size() < kNarrow && triangles.size() < kNarrow / 3) {
    check_topology<std::uint32_t>(triangles, sum.proper, report);
  } else {
    check_topology<std::uint64_t>(triangles, sum.proper, report);
  }
}

}  // namespace

bool MeshReport::defective(bool must_be_closed) const {
  return not_finite + out_of_range + degenerate + duplicate + nonmanifold_edges +
                 nonmanifold_vertices + misoriented_edges >
             0 ||
         (must_be_closed && !closed());
}

MeshReport check_mesh(const Mesh& mesh) {
  MeshReport report;
  const auto with_positions = [&]<class T>(Positions<T> positions) {
    if (mesh.triangles_u64.empty()) {
      check(positions, mesh.normals, Triangles<std::uint32_t>(mesh.triangles), report);
    } else {
      check(positions, mesh.normals, Triangles<std::uint64_t>(mesh.triangles_u64), report);
    }
  };
  if (mesh.positions_f64.empty()) {
    with_positions(Positions<float>(mesh.positions));
  } else {
    with_positions(Positions<double>(mesh.positions_f64));
  }
  return report;
}

}  // namespace mc
