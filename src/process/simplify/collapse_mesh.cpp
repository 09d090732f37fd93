// SPDX-License-Identifier: MIT
#include "process/simplify/collapse_mesh.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "base/vectors.hpp"

namespace mc::process {

namespace {

/// Square of the cosine of the largest angle that a triangle turns by, 75 degrees.
constexpr double kTurnSquared = 0.25881904510252074 * 0.25881904510252074;
/// A triangle is degenerate if its height is this part of its longest side. Positions were rounded
/// to single precision, and exactly collinear ones are computed to be a little off.
constexpr double kFlat = 1e-6;

double dot_with(const Vec3& v, const std::array<float, 3>& normal) {
  return (v[0] * normal[0] + v[1] * normal[1]) + v[2] * normal[2];
}

}  // namespace

CollapseMesh::CollapseMesh(std::vector<Vec3> positions, std::vector<std::array<float, 3>> normals,
                           std::span<const std::uint32_t> indices, std::size_t n_seam)
    : positions_(std::move(positions)),
      normals_(std::move(normals)),
      corners_(indices.size() / 3 * 4),
      next_of_vertex_(corners_.size()),
      heads_(positions_.size(), kEnd),
      n_triangles_of_(positions_.size()),
      marks_(positions_.size()),
      kinds_(positions_.size(), Kind::seam),
      n_triangles_(indices.size() / 3) {
  for (std::size_t t = n_triangles_; t-- > 0;) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t vertex = indices[3 * t + c];
      corners_[4 * t + c] = vertex;
      next_of_vertex_[4 * t + c] = heads_[vertex];
      heads_[vertex] = static_cast<std::uint32_t>(4 * t + c);
      ++n_triangles_of_[vertex];
    }
  }
  for (auto v = static_cast<std::uint32_t>(n_seam); v < n_vertices(); ++v) {
    kinds_[v] = has_closed_fan(v) ? Kind::free : Kind::border;
  }
}

/// Whether one round along the triangles leads past all of them, back to the first.
bool CollapseMesh::has_closed_fan(std::uint32_t vertex) {
  constexpr std::size_t kMaxFan = 64;
  std::array<std::array<std::uint32_t, 2>, kMaxFan> sides;
  std::size_t n = 0;
  for_corners(vertex, [&](std::uint32_t corner) {
    if (n < kMaxFan) sides[n] = {after(corner), before(corner)};
    ++n;
  });
  if (n < 3 || n > kMaxFan) return false;
  std::uint32_t at = sides[0][1];
  for (std::size_t step = 1; step < n; ++step) {
    const auto next = std::find_if(sides.begin() + static_cast<std::ptrdiff_t>(step),
                                   sides.begin() + static_cast<std::ptrdiff_t>(n),
                                   [at](const auto& side) { return side[0] == at; });
    if (next == sides.begin() + static_cast<std::ptrdiff_t>(n)) return false;
    std::swap(*next, sides[step]);
    at = sides[step][1];
  }
  return at == sides[0][0];
}

/// Whether a common neighbour would be left with two triangles that have the same vertices.
bool CollapseMesh::would_fold(std::uint32_t neighbour) const {
  const Kind kind = kinds_[neighbour];
  if (kind == Kind::border) return false;
  return n_triangles_of_[neighbour] <= (kind == Kind::free ? 3U : 2U);
}

bool CollapseMesh::keeps_topology(std::uint32_t a, std::uint32_t b) {
  mark_ += 2;
  for_corners(a, [&](std::uint32_t corner) { marks_[after(corner)] = mark_; });
  std::array<std::uint32_t, 2> common{};
  std::size_t n_common = 0;
  for_corners(b, [&](std::uint32_t corner) {
    for (const std::uint32_t neighbour : {after(corner), before(corner)}) {
      if (marks_[neighbour] != mark_) continue;
      marks_[neighbour] = mark_ + 1;  // seen
      if (n_common < 2) common[n_common] = neighbour;
      ++n_common;
    }
  });
  if (n_common != 2 || would_fold(common[0]) || would_fold(common[1])) return false;
  if (kinds_[b] != Kind::seam) return true;
  bool joins_seam = false;
  for_corners(a, [&](std::uint32_t corner) {
    const std::uint32_t neighbour = after(corner);
    const bool is_new = marks_[neighbour] == mark_ && neighbour != b;
    joins_seam = joins_seam || (is_new && kinds_[neighbour] == Kind::seam);
  });
  return !joins_seam;
}

/// Of the triangle of one corner of the vertex that moves to b.
bool CollapseMesh::keeps_shape_of(std::uint32_t corner, std::uint32_t b) const {
  const std::uint32_t a = corners_[corner];
  const std::uint32_t p = after(corner);
  const std::uint32_t q = before(corner);
  const Vec3 side = minus(positions_[q], positions_[p]);
  const Vec3 to_a = minus(positions_[a], positions_[p]);
  const Vec3 to_b = minus(positions_[b], positions_[p]);
  const Vec3 old_normal = cross(side, to_a);
  const Vec3 new_normal = cross(side, to_b);
  const double old_square = dot(old_normal, old_normal);
  const double new_square = dot(new_normal, new_normal);
  const Vec3 third = minus(positions_[q], positions_[b]);
  const double longest = std::max({dot(side, side), dot(to_b, to_b), dot(third, third)});
  if (!(new_square > kFlat * kFlat * longest * longest)) return false;
  const double turn = dot(old_normal, new_normal);
  if (old_square > 0 && (turn < 0 || turn * turn < kTurnSquared * old_square * new_square)) {
    return false;
  }
  const auto comes_to_face = [&](std::uint32_t before_it, std::uint32_t after_it) {
    return dot_with(new_normal, normals_[after_it]) < 0 &&
           dot_with(old_normal, normals_[before_it]) >= 0;
  };
  return !comes_to_face(p, p) && !comes_to_face(q, q) && !comes_to_face(a, b);
}

bool CollapseMesh::keeps_shape(std::uint32_t a, std::uint32_t b) {
  bool keeps = true;
  for_corners(a, [&](std::uint32_t corner) {
    if (!keeps || after(corner) == b || before(corner) == b) return;
    keeps = keeps_shape_of(corner, b);
  });
  return keeps;
}

void CollapseMesh::collapse(std::uint32_t a, std::uint32_t b) {
  assert(is_free(a));
  std::uint32_t last = kEnd;
  for_corners(a, [&](std::uint32_t corner) {
    if (after(corner) == b || before(corner) == b) {
      corners_[corner | 3U] = 1;
      --n_triangles_;
      --n_triangles_of_[after(corner)];
      --n_triangles_of_[before(corner)];
    } else {
      corners_[corner] = b;
      ++n_triangles_of_[b];
    }
    last = corner;
  });
  assert(last != kEnd);
  next_of_vertex_[last] = heads_[b];
  heads_[b] = heads_[a];
  heads_[a] = kEnd;
}

}  // namespace mc::process
