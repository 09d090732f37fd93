// SPDX-License-Identifier: MIT
#include "mc/simplify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/vectors.hpp"
#include "process/simplify/simplifier.hpp"
#include "process/simplify/triangle_distance.hpp"
#include "process/vertex_buffers.hpp"

// A cube is simplified in cells, from the middle of its box: coordinates are then small, and errors
// of quadrics far below those of positions.

namespace mc {

namespace {

using process::CollapseLimits;
using process::CollapseMesh;
using process::Simplifier;

/// What the first pass leaves beyond the ratio, as a part of it.
constexpr double kFirstPassSpare = 0.25;

template <class T>
std::vector<Vec3> in_cells(const Buffer<T>& positions, double cell) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> lo{kInfinity, kInfinity, kInfinity};
  std::array<double, 3> hi{-kInfinity, -kInfinity, -kInfinity};
  for (std::size_t n = 0; n < positions.size(); ++n) {
    lo[n % 3] = std::min(lo[n % 3], double{positions[n]});
    hi[n % 3] = std::max(hi[n % 3], double{positions[n]});
  }
  std::vector<Vec3> out(positions.size() / 3);
  for (std::size_t v = 0; v < out.size(); ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      out[v][a] = (positions[3 * v + a] - 0.5 * (lo[a] + hi[a])) / cell;
    }
  }
  return out;
}

/// The normals of the mesh or, if it has none, sums of those of the triangles, weighted by area.
std::vector<std::array<float, 3>> normals_of(const MeshChunk& mesh,
                                             const std::vector<Vec3>& positions) {
  std::vector<std::array<float, 3>> out(positions.size());
  if (!mesh.normals.empty()) {
    for (std::size_t n = 0; n < mesh.normals.size(); ++n) out[n / 3][n % 3] = mesh.normals[n];
    return out;
  }
  for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
    const std::uint32_t* corner = &mesh.indices[3 * t];
    const Vec3& a = positions[corner[0]];
    const Vec3 normal = cross(minus(positions[corner[1]], a), minus(positions[corner[2]], a));
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t n = 0; n < 3; ++n) out[corner[c]][n] += static_cast<float>(normal[n]);
    }
  }
  return out;
}

/// In the first pass, the vertices that may go are thinned out to somewhat more than the ratio:
/// those of the seam wait for the second one, which brings all triangles down to it, and must find
/// enough of them wherever the first one has left few.
CollapseLimits limits_of(const SimplifyGoal& goal, const MeshCube& cube, std::size_t n_free) {
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  constexpr double kAny = std::numeric_limits<double>::infinity();
  if (goal.by == SimplifyGoal::By::error) return {kAll, 0, goal.error};
  const double n_mesh = static_cast<double>(std::max<std::uint64_t>(cube.n_mesh, 1));
  const double ratio = goal.by == SimplifyGoal::By::ratio
                           ? goal.ratio
                           : std::min(1.0, static_cast<double>(goal.count) / n_mesh);
  if (cube.is_last_pass) return {kAll, ratio * cube.n_extracted, kAny};
  const double thinned = ratio * (1 + kFirstPassSpare * (1 - ratio));
  return {static_cast<std::size_t>((1 - thinned) * static_cast<double>(n_free)), 0, kAny};
}

/// Square of the distance of a point from the triangles around a vertex, or around the vertices
/// that lead nearer to it from there.
double squared_distance(CollapseMesh& mesh, const Vec3& point, std::uint32_t vertex) {
  double least = std::numeric_limits<double>::infinity();
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    const std::uint32_t from = vertex;
    mesh.for_corners(from, [&](std::uint32_t corner) {
      const std::uint32_t b = mesh.after(corner);
      const std::uint32_t c = mesh.before(corner);
      const process::NearestPoint nearest =
          process::nearest_point(point, mesh.position(from), mesh.position(b), mesh.position(c));
      if (!(nearest.square < least)) return;
      least = nearest.square;
      goes_on = nearest.far_corner != 0;
      vertex = nearest.far_corner == 1 ? b : c;
    });
  }
  return least;
}

/// Distances of the vertices that are gone from where they ended.
VertexDistances measure(Simplifier& simplifier, double cell) {
  CollapseMesh& mesh = simplifier.mesh();
  VertexDistances out;
  out.n = mesh.n_vertices();
  double max_square = 0;
  for (std::uint32_t v = 0; v < mesh.n_vertices(); ++v) {
    if (!simplifier.is_gone(v)) continue;
    const double square = squared_distance(mesh, mesh.position(v), simplifier.end_of(v));
    out.sum_squares += square;
    max_square = std::max(max_square, square);
  }
  out.sum_squares *= cell * cell;
  out.max = std::sqrt(max_square) * cell;
  return out;
}

/// Leaves what remains, in its order.
void write(Simplifier& simplifier, MeshChunk& chunk) {
  const CollapseMesh& mesh = simplifier.mesh();
  std::vector<std::uint32_t> numbers(mesh.n_vertices());
  std::uint32_t n = 0;
  for (std::uint32_t v = 0; v < mesh.n_vertices(); ++v) {
    numbers[v] = n;
    if (simplifier.is_gone(v)) continue;
    process::for_vertex_buffers(chunk, [&](auto& buffer, std::size_t each) {
      if (!buffer.empty()) std::copy_n(&buffer[each * v], each, &buffer[each * n]);
    });
    ++n;
  }
  process::for_vertex_buffers(chunk, [n](auto& buffer, std::size_t each) {
    if (!buffer.empty()) buffer.resize(each * n);
  });
  std::size_t end = 0;
  for (std::size_t t = 0; t < mesh.n_all_triangles(); ++t) {
    if (mesh.is_gone(t)) continue;
    for (std::size_t c = 0; c < 3; ++c) chunk.indices[end++] = numbers[mesh.triangle(t)[c]];
  }
  chunk.indices.resize(end);
}

}  // namespace

StageBytes Simplify::bytes() const {
  return {0, process::kSimplifierVertexBytes, process::kSimplifierTriangleBytes};
}

void Simplify::apply(MeshCube& cube) const {
  MeshChunk& chunk = cube.mesh;
  std::vector<Vec3> positions = chunk.positions_f64.empty()
                                    ? in_cells(chunk.positions, cube.cell)
                                    : in_cells(chunk.positions_f64, cube.cell);
  std::vector<std::array<float, 3>> normals = normals_of(chunk, positions);
  Simplifier simplifier(
      CollapseMesh(std::move(positions), std::move(normals), chunk.indices, cube.n_seam));
  simplifier.run(limits_of(goal_, cube, simplifier.n_free()));
  cube.distances = measure(simplifier, cube.cell);
  write(simplifier, chunk);
}

}  // namespace mc
