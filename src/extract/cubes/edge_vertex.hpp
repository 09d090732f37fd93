// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "extract/bits/threshold.hpp"
#include "extract/cubes/case_table.hpp"
#include "mc/extract.hpp"

// The vertex on a crossed lattice edge: where on the edge, where in the world, and its normal, one
// at a time; vertex_kernels.hpp does the same for many. Dense and sparse engines share every line,
// so that they give the same bits. A Sampler answers
//   Real at(Index3)           the sample as a Real; inside the box only
//   T raw(Index3)             the sample itself
//   const IndexBox& box()     the samples there are
// All arithmetic is in one fixed order without fused multiply-add.

namespace mc::extraction {

/// What samples of type T are interpolated in.
template <class T>
using Real =
    std::conditional_t<std::is_same_v<T, double> || (sizeof(T) >= 4 && std::is_integral_v<T>),
                       double, float>;

/// An edge of the lattice, named by its lower sample.
struct LatticeEdge {
  Index3 lower;
  Axis axis;
};

inline Index3 step(Index3 p, Axis axis, std::int32_t by = 1) {
  p[axis] += by;
  return p;
}

/// Where on an edge the surface crosses.
template <class R>
struct EdgeRule {
  R iso;
  R cutoff;
  R low;   ///< min_edge
  R high;  ///< 1 - min_edge
  bool midpoint;

  explicit EdgeRule(const ExtractOptions& o)
      : iso(static_cast<R>(o.iso)),
        cutoff(static_cast<R>(o.cutoff)),
        low(static_cast<R>(o.min_edge)),
        high(R{1} - static_cast<R>(o.min_edge)),
        midpoint(o.interpolation == Interpolation::midpoint) {}

  /// The parameter in [low, high] for values a (lower sample) and b.
  [[nodiscard]] R parameter(R a, R b) const noexcept {
    const R difference = b - a;
    if (midpoint || std::abs(difference) < cutoff) {
      return R{0.5};
    }
    R t = (iso - a) / difference;
    if (!std::isfinite(t) || !std::isfinite(difference)) {
      t = R{0.5};
    }
    return std::min(std::max(t, low), high);
  }
};

/// From lattice to world: positions relative to the options' origin, and normals.
struct Placement {
  Affine map;  ///< translation less the origin
  std::array<double, 9>
      cofactors;   ///< times the sign of the determinant: turns covectors into world
  bool flip;       ///< whether table triangles must be turned round
  double outward;  ///< -1 where values grow into the solid

  Placement(const Affine& to_world, const ExtractOptions& o) : map(to_world) {
    // Scaled by a power of two, so that products of very small or large spacings stay finite.
    std::array<double, 12> m = map.m;
    double largest_entry = 0;
    for (const std::size_t n : {0U, 1U, 2U, 4U, 5U, 6U, 8U, 9U, 10U}) {
      largest_entry = std::max(largest_entry, std::abs(m[n]));
    }
    const int exponent = largest_entry > 0 ? std::ilogb(largest_entry) : 0;
    for (double& x : m) {
      x = std::ldexp(x, -exponent);
    }
    const double sign = Affine{m}.determinant() < 0 ? -1 : 1;
    cofactors = {sign * (m[5] * m[10] - m[6] * m[9]), sign * (m[6] * m[8] - m[4] * m[10]),
                 sign * (m[4] * m[9] - m[5] * m[8]),  sign * (m[2] * m[9] - m[1] * m[10]),
                 sign * (m[0] * m[10] - m[2] * m[8]), sign * (m[1] * m[8] - m[0] * m[9]),
                 sign * (m[1] * m[6] - m[2] * m[5]),  sign * (m[2] * m[4] - m[0] * m[6]),
                 sign * (m[0] * m[5] - m[1] * m[4])};
    double largest = 0;
    for (const double c : cofactors) {
      largest = std::max(largest, std::abs(c));
    }
    for (double& c : cofactors) {
      c /= largest;
    }
    for (std::size_t a = 0; a < 3; ++a) {
      map.m[4 * a + 3] -= o.origin[a];
    }
    flip = (o.inside == Inside::below) != (sign < 0);
    outward = o.inside == Inside::above ? -1 : 1;
  }

  /// The map without its translation.
  [[nodiscard]] Vec3 linear(const Vec3& p) const noexcept {
    const std::array<double, 12>& m = map.m;
    return {(m[0] * p[0] + m[1] * p[1]) + m[2] * p[2], (m[4] * p[0] + m[5] * p[1]) + m[6] * p[2],
            (m[8] * p[0] + m[9] * p[1]) + m[10] * p[2]};
  }

  /// The world direction of an index covector; not normalised.
  [[nodiscard]] Vec3 turned(const Vec3& g) const noexcept {
    const std::array<double, 9>& c = cofactors;
    return {(c[0] * g[0] + c[1] * g[1]) + c[2] * g[2], (c[3] * g[0] + c[4] * g[1]) + c[5] * g[2],
            (c[6] * g[0] + c[7] * g[1]) + c[8] * g[2]};
  }
};

inline double largest_of(const Vec3& v) {
  return std::max(std::max(std::abs(v[0]), std::abs(v[1])), std::abs(v[2]));
}

/// Squared lengths that are neither lost nor overflow.
inline constexpr double kShortestSquare = 0x1p-900;
inline constexpr double kLongestSquare = 0x1p900;

inline double square_of(const Vec3& v) { return (v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]; }

/// Unit length, or false where the vector is zero or not finite.
inline bool normalise(Vec3& v) {
  double square = square_of(v);
  if (!(square >= kShortestSquare && square <= kLongestSquare)) {
    const double scale = largest_of(v);
    if (!(scale > 0) || !std::isfinite(scale) || !std::isfinite((v[0] + v[1]) + v[2])) {
      return false;
    }
    for (double& x : v) {
      x /= scale;
    }
    square = square_of(v);
  }
  const double inverse = 1 / std::sqrt(square);
  for (double& x : v) {
    x *= inverse;
  }
  return true;
}

/// What all of a run's vertices have in common.
template <class T>
struct VertexRules {
  using R = Real<T>;
  EdgeRule<R> edge;
  Placement placement;
  Threshold threshold;
  Normals normals;
  bool capped;       ///< a layer of constant samples surrounds the box
  bool above_there;  ///< what that layer is
  bool solid_above;

  VertexRules(const ExtractOptions& o, const Affine& to_world, const Threshold& predicate)
      : edge(o),
        placement(to_world, o),
        threshold(predicate),
        normals(o.normals),
        capped(o.border != Border::open),
        above_there((o.border == Border::solid) == (o.inside == Inside::above)),
        solid_above(o.inside == Inside::above) {}
};

/// Samples around one place, and the geometry that follows from them.
template <class T, class Sampler>
class EdgeVertices {
 public:
  using R = Real<T>;

  EdgeVertices(const VertexRules<T>& rules, const Sampler& sampler)
      : rules_(rules), sampler_(sampler) {}

  /// Whether the edge leads to the layer around the box: -1 at its lower end, 1 at its upper.
  [[nodiscard]] int leads_out(const LatticeEdge& e) const noexcept {
    const std::int32_t at = e.lower[e.axis];
    return at < sampler_.box().lo[e.axis] ? -1 : at >= sampler_.box().hi[e.axis] ? 1 : 0;
  }

  /// The parameter of an edge to the layer outside, which is cut next to the border sample.
  [[nodiscard]] R outer_parameter(int leads_out) const noexcept {
    return leads_out < 0 ? rules_.edge.high : rules_.edge.low;
  }

  /// The edge's parameter.
  [[nodiscard]] R parameter(const LatticeEdge& e) const noexcept {
    const int out = leads_out(e);
    return out != 0
               ? outer_parameter(out)
               : rules_.edge.parameter(sampler_.at(e.lower), sampler_.at(step(e.lower, e.axis)));
  }

  /// Central differences, one-sided at the box's border, per step of the lattice.
  [[nodiscard]] std::array<R, 3> gradient(const Index3& p) const noexcept {
    std::array<R, 3> g;
    for (std::size_t a = 0; a < 3; ++a) {
      Index3 before = p;
      Index3 behind = p;
      before[a] = std::max(p[a] - 1, sampler_.box().lo[a]);
      behind[a] = std::min(p[a] + 1, sampler_.box().hi[a]);
      g[a] = sampler_.at(behind) - sampler_.at(before);
      if (behind[a] - before[a] == 2) {
        g[a] *= R{0.5};
      }
    }
    return g;
  }

  [[nodiscard]] std::array<float, 3> normal(const LatticeEdge& e, R t) const noexcept {
    Vec3 n{};
    if (rules_.normals == Normals::face) {
      n = face_sum(e);
    } else if (leads_out(e) == 0) {
      n = gradient_between(e, t);
    }
    if (!normalise(n)) {
      n = edge_direction(e);
    }
    return {static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])};
  }

  /// The area vector of one triangle of a cell: half the cross product of its sides, outward. From
  /// unrounded positions relative to the cell, so that it is the same wherever the volume lies and
  /// however its positions are stored. `corner` takes the first corner, relative to the cell.
  [[nodiscard]] Vec3 area_vector(const Index3& cell, const CaseRow& row, std::size_t triangle,
                                 Vec3* corner = nullptr) const noexcept {
    std::array<Vec3, 3> p;
    for (std::size_t n = 0; n < 3; ++n) {
      p[n] = within_cell(cell, row.edges[3 * triangle + n]);
    }
    if (rules_.placement.flip) {
      std::swap(p[1], p[2]);
    }
    if (corner != nullptr) {
      *corner = p[0];
    }
    const Vec3 a{p[1][0] - p[0][0], p[1][1] - p[0][1], p[1][2] - p[0][2]};
    const Vec3 b{p[2][0] - p[0][0], p[2][1] - p[0][1], p[2][2] - p[0][2]};
    return {0.5 * (a[1] * b[2] - a[2] * b[1]), 0.5 * (a[2] * b[0] - a[0] * b[2]),
            0.5 * (a[0] * b[1] - a[1] * b[0])};
  }

  /// The case of the cell whose lowest corner is `cell`; corners outside the box count as the
  /// layer.
  [[nodiscard]] CellCase case_of(const Index3& cell) const noexcept {
    CellCase out;
    for (std::size_t n = 0; n < kCorners; ++n) {
      const Corner corner(n);
      const Index3 p = corner.of(cell);
      out.set(corner, sampler_.box().contains(p) ? is_above(sampler_.raw(p), rules_.threshold)
                                                 : rules_.above_there);
    }
    return out;
  }

 private:
  static LatticeEdge edge_of(const Index3& cell, CellEdge edge) {
    return {edge.lower().of(cell), edge.axis()};
  }
  /// The vertex on an edge of a cell, in the world but for translation, relative to the cell's
  /// lowest corner.
  [[nodiscard]] Vec3 within_cell(const Index3& cell, CellEdge edge) const noexcept {
    const LatticeEdge e = edge_of(cell, edge);
    Vec3 p;
    for (const Axis axis : kAxes) p[axis] = edge.lower().along(axis);
    p[e.axis] += static_cast<double>(parameter(e));
    return rules_.placement.linear(p);
  }

  /// The world direction out of the solid by the gradient at the vertex.
  [[nodiscard]] Vec3 gradient_between(const LatticeEdge& e, R t) const noexcept {
    const std::array<R, 3> a = gradient(e.lower);
    const std::array<R, 3> b = gradient(step(e.lower, e.axis));
    Vec3 g;
    for (std::size_t n = 0; n < 3; ++n) {
      g[n] = rules_.placement.outward * static_cast<double>(a[n] + t * (b[n] - a[n]));
    }
    // Products with the cofactors (at most 1) must not overflow.
    if (std::is_same_v<R, double> && largest_of(g) > 1e300) {
      for (double& x : g) {
        x *= 1e-10;
      }
    }
    return rules_.placement.turned(g);
  }

  /// The edge's own direction, from solid to not solid.
  [[nodiscard]] Vec3 edge_direction(const LatticeEdge& e) const noexcept {
    const bool lower_in = sampler_.box().contains(e.lower);
    const bool lower_above =
        lower_in ? is_above(sampler_.raw(e.lower), rules_.threshold) : rules_.above_there;
    Vec3 g{};
    g[e.axis] = lower_above == rules_.solid_above ? 1 : -1;
    Vec3 n = rules_.placement.turned(g);
    normalise(n);
    return n;
  }

  /// The sum of the area vectors of all triangles at the vertex: cells in order, triangles in table
  /// order, whatever slab or block they belong to.
  [[nodiscard]] Vec3 face_sum(const LatticeEdge& e) const noexcept {
    const Axis u = kAxes[e.axis == 0 ? 1 : 0];
    const Axis v = kAxes[e.axis == 2 ? 1 : 2];
    Vec3 sum{};
    for (int n = 0; n < 4; ++n) {
      const Index3 cell = step(step(e.lower, u, (n & 1) - 1), v, (n >> 1) - 1);
      if (!cell_exists(cell)) {
        continue;
      }
      const CaseRow& row = kCases[case_of(cell)];
      for (std::size_t t = 0; t < row.n_triangles; ++t) {
        if (uses(cell, row, t, e)) {
          const Vec3 area = area_vector(cell, row, t);
          for (std::size_t a = 0; a < 3; ++a) {
            sum[a] += area[a];
          }
        }
      }
    }
    return sum;
  }

  [[nodiscard]] bool cell_exists(const Index3& cell) const noexcept {
    const std::int32_t margin = rules_.capped ? 1 : 0;
    for (std::size_t a = 0; a < 3; ++a) {
      if (cell[a] < sampler_.box().lo[a] - margin || cell[a] >= sampler_.box().hi[a] + margin) {
        return false;
      }
    }
    return true;
  }

  static bool uses(const Index3& cell, const CaseRow& row, std::size_t triangle,
                   const LatticeEdge& e) {
    for (std::size_t n = 0; n < 3; ++n) {
      const LatticeEdge other = edge_of(cell, row.edges[3 * triangle + n]);
      if (other.axis == e.axis && other.lower == e.lower) {
        return true;
      }
    }
    return false;
  }

  const VertexRules<T>& rules_;
  const Sampler& sampler_;
};

}  // namespace mc::extraction
