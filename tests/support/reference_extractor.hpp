// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <type_traits>
#include <vector>

#include "extract/cubes/case_table.hpp"
#include "field/visit_type.hpp"
#include "mc/extract.hpp"

// The extractor as one would write it on a blackboard: a sample at a time, a map from lattice edge
// to vertex, no bits, no slabs, no threads. Only the case table is shared with the engine, and has
// tests of its own.

namespace mc::test {

template <class T>
class ReferenceExtractor {
 public:
  using R =
      std::conditional_t<std::is_same_v<T, double> || (std::is_integral_v<T> && sizeof(T) >= 4),
                         double, float>;

  ReferenceExtractor(const std::vector<T>& samples, Index3 dims, ExtractOptions options,
                     Affine to_world)
      : samples_(samples), dims_(dims), o_(std::move(options)), to_world_(to_world) {
    box_ = o_.region.value_or(IndexBox{{0, 0, 0}, {dims[0] - 1, dims[1] - 1, dims[2] - 1}});
    pad_ = o_.border == Border::open ? 0 : 1;
  }

  Mesh extract() {
    for (int k = box_.lo[2] - pad_; k <= box_.hi[2] + pad_; ++k) {
      for (int j = box_.lo[1] - pad_; j <= box_.hi[1] + pad_; ++j) {
        row(j, k, 0);
        row(j, k, 1);
      }
      for (int j = box_.lo[1] - pad_; j <= box_.hi[1] + pad_; ++j) row(j, k, 2);
    }
    for (int k = box_.lo[2] - pad_; k < box_.hi[2] + pad_; ++k) {
      for (int j = box_.lo[1] - pad_; j < box_.hi[1] + pad_; ++j) {
        for (int i = box_.lo[0] - pad_; i < box_.hi[0] + pad_; ++i) cell(i, j, k);
      }
    }
    if (o_.normals == Normals::face) face_normals();
    return mesh_;
  }

  /// What remains of the whole surface without the cells that stick out of `part`.
  Mesh extract_part(const IndexBox& part) {
    const Mesh whole = extract();
    Mesh mesh;
    std::vector<std::uint32_t> ids(whole.positions.size());
    for (std::size_t v = 0; v < ids.size(); ++v) {
      if (!holds(part, edges_[v])) continue;
      ids[v] = static_cast<std::uint32_t>(mesh.positions.size());
      mesh.positions.push_back(whole.positions[v]);
      if (!whole.normals.empty()) mesh.normals.push_back(whole.normals[v]);
    }
    for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
      const auto& [i, j, k] = cells_[t];
      if (!part.contains(IndexBox{{i, j, k}, {i + 1, j + 1, k + 1}})) continue;
      const auto& [a, b, c] = whole.triangles[t];
      mesh.triangles.push_back({ids[a], ids[b], ids[c]});
    }
    return mesh;
  }

 private:
  using Edge = std::tuple<int, int, int, int>;  // i, j, k, axis

  static bool holds(const IndexBox& box, const Edge& edge) {
    const auto& [i, j, k, axis] = edge;
    return box.contains(Index3{i, j, k}) &&
           box.contains(Index3{i + (axis == 0), j + (axis == 1), k + (axis == 2)});
  }
  [[nodiscard]] bool in_box(int i, int j, int k) const { return box_.contains(Index3{i, j, k}); }
  [[nodiscard]] T raw(int i, int j, int k) const {
    return samples_[static_cast<std::size_t>(i) +
                    static_cast<std::size_t>(dims_[0]) *
                        (static_cast<std::size_t>(j) +
                         static_cast<std::size_t>(dims_[1]) * static_cast<std::size_t>(k))];
  }
  [[nodiscard]] R value(int i, int j, int k) const {
    return static_cast<R>(field::number(raw(i, j, k)));
  }
  [[nodiscard]] bool above(int i, int j, int k) const {
    if (!in_box(i, j, k)) return (o_.border == Border::solid) == (o_.inside == Inside::above);
    const auto v = field::number(raw(i, j, k));
    if constexpr (std::is_integral_v<T>) {
      return static_cast<long double>(v) >= static_cast<long double>(o_.iso);
    } else {
      const auto iso = static_cast<decltype(v)>(o_.iso);
      return o_.inside == Inside::above ? v >= iso : !(v < iso);
    }
  }

  void row(int j, int k, int axis) {
    for (int i = box_.lo[0] - pad_; i <= box_.hi[0] + pad_; ++i) {
      const int i2 = i + (axis == 0);
      const int j2 = j + (axis == 1);
      const int k2 = k + (axis == 2);
      if (i2 > box_.hi[0] + pad_ || j2 > box_.hi[1] + pad_ || k2 > box_.hi[2] + pad_) continue;
      if (above(i, j, k) != above(i2, j2, k2)) vertex({i, j, k}, {i2, j2, k2}, axis);
    }
  }

  void vertex(std::array<int, 3> a, std::array<int, 3> b, int axis) {
    const R low = static_cast<R>(o_.min_edge);
    const R high = R{1} - low;
    const bool a_in = in_box(a[0], a[1], a[2]);
    const bool b_in = in_box(b[0], b[1], b[2]);
    R t = !a_in ? high : low;
    if (a_in && b_in) {
      const R va = value(a[0], a[1], a[2]);
      const R d = value(b[0], b[1], b[2]) - va;
      t = (static_cast<R>(o_.iso) - va) / d;
      if (o_.interpolation == Interpolation::midpoint || std::fabs(d) < static_cast<R>(o_.cutoff) ||
          !std::isfinite(t) || !std::isfinite(d)) {
        t = R{0.5};
      }
      if (t < low) t = low;
      if (t > high) t = high;
    }
    Vec3 p{static_cast<double>(a[0]), static_cast<double>(a[1]), static_cast<double>(a[2])};
    p[static_cast<std::size_t>(axis)] += static_cast<double>(t);
    Affine shifted = to_world_;
    for (std::size_t n = 0; n < 3; ++n) shifted.m[4 * n + 3] -= o_.origin[n];
    const Vec3 w = shifted(p);
    ids_[{a[0], a[1], a[2], axis}] = static_cast<std::uint32_t>(mesh_.positions.size());
    edges_.push_back({a[0], a[1], a[2], axis});
    mesh_.positions.push_back(
        {static_cast<float>(w[0]), static_cast<float>(w[1]), static_cast<float>(w[2])});
    if (o_.normals == Normals::gradient) {
      mesh_.normals.push_back(gradient_normal(a, b, axis, t, a_in && b_in));
    }
    directions_.push_back(direction(a, axis));
    parameters_.push_back(static_cast<double>(t));
    area_sums_.push_back({});
  }

  [[nodiscard]] R slope(std::array<int, 3> p, std::size_t axis) const {
    std::array<int, 3> lo = p;
    std::array<int, 3> hi = p;
    R scale{1};
    if (p[axis] > box_.lo[axis] && p[axis] < box_.hi[axis]) scale = R{0.5};
    if (p[axis] > box_.lo[axis]) --lo[axis];
    if (p[axis] < box_.hi[axis]) ++hi[axis];
    return (value(hi[0], hi[1], hi[2]) - value(lo[0], lo[1], lo[2])) * scale;
  }

  /// Inverse transpose of the map's linear part, up to a positive factor, in Placement's rounding.
  [[nodiscard]] Vec3 turned(const Vec3& g) const {
    const auto& m = to_world_.m;
    std::array<double, 9> c{
        m[5] * m[10] - m[6] * m[9], m[6] * m[8] - m[4] * m[10], m[4] * m[9] - m[5] * m[8],
        m[2] * m[9] - m[1] * m[10], m[0] * m[10] - m[2] * m[8], m[1] * m[8] - m[0] * m[9],
        m[1] * m[6] - m[2] * m[5],  m[2] * m[4] - m[0] * m[6],  m[0] * m[5] - m[1] * m[4]};
    double largest = 0;
    for (const double x : c) largest = std::fmax(largest, std::fabs(x));
    for (double& x : c) x = x * (to_world_.determinant() < 0 ? -1 : 1) / largest;
    return {(c[0] * g[0] + c[1] * g[1]) + c[2] * g[2], (c[3] * g[0] + c[4] * g[1]) + c[5] * g[2],
            (c[6] * g[0] + c[7] * g[1]) + c[8] * g[2]};
  }

  static bool unit(Vec3& v) {
    const bool finite = std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
    double square = (v[0] * v[0] + v[1] * v[1]) + v[2] * v[2];
    if (!finite || (v[0] == 0 && v[1] == 0 && v[2] == 0)) return false;
    if (square < 0x1p-900 || square > 0x1p900) {
      const double s = std::fmax(std::fmax(std::fabs(v[0]), std::fabs(v[1])), std::fabs(v[2]));
      for (double& x : v) x /= s;
      square = (v[0] * v[0] + v[1] * v[1]) + v[2] * v[2];
    }
    const double inverse = 1 / std::sqrt(square);
    for (double& x : v) x *= inverse;
    return true;
  }
  static std::array<float, 3> narrow(const Vec3& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
  }

  /// From solid to not solid along the edge.
  [[nodiscard]] std::array<float, 3> direction(std::array<int, 3> a, int axis) const {
    const bool solid_above = o_.inside == Inside::above;
    Vec3 g{};
    g[static_cast<std::size_t>(axis)] = above(a[0], a[1], a[2]) == solid_above ? 1 : -1;
    Vec3 n = turned(g);
    unit(n);
    return narrow(n);
  }

  [[nodiscard]] std::array<float, 3> gradient_normal(std::array<int, 3> a, std::array<int, 3> b,
                                                     int axis, R t, bool inner) const {
    if (!inner) return direction(a, axis);
    Vec3 g;
    for (std::size_t n = 0; n < 3; ++n) {
      const R ga = slope(a, n);
      const R gb = slope(b, n);
      g[n] = (o_.inside == Inside::above ? -1.0 : 1.0) * static_cast<double>(ga + t * (gb - ga));
    }
    Vec3 n = turned(g);
    return unit(n) ? narrow(n) : direction(a, axis);
  }

  void cell(int i, int j, int k) {
    unsigned cell_case = 0;
    for (int c = 0; c < 8; ++c) {
      cell_case |= static_cast<unsigned>(above(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))) << c;
    }
    const extraction::CaseRow& row = extraction::kCases[cell_case];
    const bool flip = (o_.inside == Inside::below) != (to_world_.determinant() < 0);
    for (std::size_t t = 0; t < row.n_triangles; ++t) {
      std::array<std::uint32_t, 3> ids{};
      std::array<extraction::CellEdge, 3> edges{row.edges[3 * t], row.edges[3 * t + 1],
                                                row.edges[3 * t + 2]};
      for (std::size_t n = 0; n < 3; ++n) {
        const Index3 lower = edges[n].lower().of({i, j, k});
        ids[n] = ids_.at({lower[0], lower[1], lower[2], static_cast<int>(edges[n].axis())});
      }
      if (flip) {
        std::swap(ids[1], ids[2]);
        std::swap(edges[1], edges[2]);
      }
      mesh_.triangles.push_back(ids);
      cells_.push_back({i, j, k});
      add_area(ids, edges);
    }
  }

  /// Adds a triangle's area vector to its three vertices, from places relative to its cell.
  void add_area(const std::array<std::uint32_t, 3>& ids,
                const std::array<extraction::CellEdge, 3>& edges) {
    const auto& m = to_world_.m;
    std::array<Vec3, 3> p;
    for (std::size_t n = 0; n < 3; ++n) {
      Vec3 q;
      for (const extraction::Axis a : extraction::kAxes) q[a] = edges[n].lower().along(a);
      q[edges[n].axis()] += parameters_[ids[n]];
      for (std::size_t r = 0; r < 3; ++r) {
        p[n][r] = (m[4 * r] * q[0] + m[4 * r + 1] * q[1]) + m[4 * r + 2] * q[2];
      }
    }
    const Vec3 a{p[1][0] - p[0][0], p[1][1] - p[0][1], p[1][2] - p[0][2]};
    const Vec3 b{p[2][0] - p[0][0], p[2][1] - p[0][1], p[2][2] - p[0][2]};
    const Vec3 area{0.5 * (a[1] * b[2] - a[2] * b[1]), 0.5 * (a[2] * b[0] - a[0] * b[2]),
                    0.5 * (a[0] * b[1] - a[1] * b[0])};
    for (const std::uint32_t id : ids) {
      for (std::size_t n = 0; n < 3; ++n) area_sums_[id][n] += area[n];
    }
  }

  void face_normals() {
    for (std::size_t v = 0; v < area_sums_.size(); ++v) {
      mesh_.normals.push_back(unit(area_sums_[v]) ? narrow(area_sums_[v]) : directions_[v]);
    }
  }

  const std::vector<T>& samples_;
  Index3 dims_;
  ExtractOptions o_;
  Affine to_world_;
  IndexBox box_;
  int pad_;
  std::map<Edge, std::uint32_t> ids_;
  std::vector<Edge> edges_;    // of the vertices
  std::vector<Index3> cells_;  // of the triangles
  std::vector<std::array<float, 3>> directions_;
  std::vector<double> parameters_;
  std::vector<Vec3> area_sums_;
  Mesh mesh_;
};

template <class T>
Mesh reference_extract(const std::vector<T>& samples, Index3 dims, const ExtractOptions& options,
                       const Affine& to_world = {}) {
  return ReferenceExtractor<T>(samples, dims, options, to_world).extract();
}

}  // namespace mc::test
