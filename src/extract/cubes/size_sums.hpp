// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/vectors.hpp"
#include "extract/cubes/edge_vertex.hpp"
#include "mc/components.hpp"

// Volumes and areas of components, added up as integers, so that the sums do not depend on the
// order of their terms: neither on threads nor on how the volume is divided into slabs.

namespace mc::extraction {

/// Which size of a component is added up: what a rule asks for.
enum class SizeKind : std::uint8_t { volume, area };
inline SizeKind size_kind_of(const KeepRule& rule) {
  return rule.by == KeepRule::By::area ? SizeKind::area : SizeKind::volume;
}

/// Turns sizes of triangles into integers and sums of them back.
///
/// A volume is that of the cones from `apex` to the triangles; for a closed surface it does not
/// depend on the apex. The unit is a fraction of a cell such that a component as large as all cells
/// stays below 2^62. Sums wrap around on the way there, which does no harm.
class SizeUnit {
 public:
  /// `cell` holds the world's map in its linear part; `n_cells` are those of the whole volume.
  SizeUnit(SizeKind kind, const Affine& map, const Vec3& apex, double n_cells)
      : apex_(apex), kind_(kind) {
    double cell = std::abs(map.determinant());
    if (kind == SizeKind::area) {
      cell = 0;
      for (int axis = 0; axis < 3; ++axis) cell = std::max(cell, map.spacing(axis));
      cell *= cell;
    }
    const int bits = std::clamp(60 - std::ilogb(std::max(n_cells, 1.0)), 8, 40);
    unit_ = std::ldexp(cell, -bits);
    per_unit_ = 1 / unit_;
  }

  /// A triangle with an infinite position has no size.
  [[nodiscard]] std::int64_t of(const std::array<Vec3, 3>& p) const {
    const Vec3 n = cross(minus(p[1], p[0]), minus(p[2], p[0]));
    const double size = kind_ == SizeKind::area ? length(n) / 2 : dot(minus(p[0], apex_), n) / 6;
    const double units = size * per_unit_;
    return std::abs(units) < 0x1p62 ? static_cast<std::int64_t>(units) : 0;
  }
  [[nodiscard]] double size_of(std::uint64_t sum) const {
    return static_cast<double>(static_cast<std::int64_t>(sum)) * unit_;
  }
  [[nodiscard]] SizeKind kind() const { return kind_; }

 private:
  Vec3 apex_;
  double unit_ = 1, per_unit_ = 1;
  SizeKind kind_;
};

/// Hands each triangle of a cell with its size to add(corner, size); `corner` is a solid corner of
/// the cell, of the component that the triangle belongs to. Positions are those that are stored.
template <class T, class Sampler, class Add>
void for_each_triangle_size(const EdgeVertices<T, Sampler>& vertices, const Placement& placement,
                            Precision precision, const SizeUnit& unit, Inside inside,
                            const Index3& cell, CellCase cell_case, Add&& add) {
  const CaseRow& row = kCases[cell_case];
  std::array<Vec3, kEdges> at;
  std::array<bool, kEdges> known{};
  const auto position = [&](CellEdge edge) -> const Vec3& {
    if (!known[edge]) {
      const Index3 lower = edge.lower().of(cell);
      Vec3 p{static_cast<double>(lower[0]), static_cast<double>(lower[1]),
             static_cast<double>(lower[2])};
      p[edge.axis()] += static_cast<double>(vertices.parameter({lower, edge.axis()}));
      at[edge] = placement.map(p);
      for (double& x : at[edge]) {
        x = precision == Precision::f32 ? static_cast<double>(static_cast<float>(x)) : x;
      }
      known[edge] = true;
    }
    return at[edge];
  };
  for (std::size_t t = 0; t < row.n_triangles; ++t) {
    std::array<Vec3, 3> p;
    for (std::size_t n = 0; n < 3; ++n) p[n] = position(edge_at(row, 3 * t + n, placement.flip));
    const CellEdge edge = row.edges[3 * t];
    const bool lower_solid = cell_case.above(edge.lower()) == (inside == Inside::above);
    add(lower_solid ? edge.lower() : edge.upper(), unit.of(p));
  }
}

}  // namespace mc::extraction
