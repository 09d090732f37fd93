// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "mc/simplify.hpp"
#include "process/simplify/collapse_mesh.hpp"
#include "process/simplify/collapse_queue.hpp"
#include "process/simplify/simplifier.hpp"
#include "process/simplify/triangle_distance.hpp"

// Each rule of collapses on a mesh that only this rule saves.

namespace mc::process {
namespace {

using Normal = std::array<float, 3>;

constexpr Normal kUp{0, 0, 1};

/// Faces nowhere: no rule about normals applies.
std::vector<Normal> no_normals(std::size_t n) { return std::vector<Normal>(n); }

CollapseMesh mesh_of(const std::vector<Vec3>& positions, const std::vector<std::uint32_t>& indices,
                     std::size_t n_seam = 0) {
  return {positions, no_normals(positions.size()), indices, n_seam};
}

/// Vertex 6 in the middle of a regular hexagon of vertices 0 to 5.
struct Hexagon {
  Hexagon() {
    for (int n = 0; n < 6; ++n) {
      positions.push_back({std::cos(n * M_PI / 3), std::sin(n * M_PI / 3), 0});
    }
    positions.push_back({0, 0, 0});
    for (std::uint32_t n = 0; n < 6; ++n) {
      for (const std::uint32_t v : {n, (n + 1) % 6, 6U}) indices.push_back(v);
    }
  }
  [[nodiscard]] CollapseMesh mesh(std::size_t n_seam = 0) const {
    return {positions, normals, indices, n_seam};
  }
  std::vector<Vec3> positions;
  std::vector<Normal> normals = no_normals(7);
  std::vector<std::uint32_t> indices;
};

TEST(CollapseMesh, FreesVerticesWithOneClosedFan) {
  const Hexagon hexagon;
  CollapseMesh mesh = hexagon.mesh(1);
  EXPECT_FALSE(mesh.is_free(0));  // seam
  EXPECT_FALSE(mesh.is_free(3));  // border
  EXPECT_TRUE(mesh.is_free(6));
  EXPECT_TRUE(mesh.keeps_topology(6, 3));
  EXPECT_TRUE(mesh.keeps_shape(6, 3));
  // Two closed fans at vertex 0.
  const std::vector<std::uint32_t> two{0, 1, 2, 0, 2, 3, 0, 3, 1, 0, 4, 5, 0, 5, 6, 0, 6, 4};
  EXPECT_FALSE(mesh_of(std::vector<Vec3>(7), two).is_free(0));
}

TEST(CollapseMesh, KeepsANeckOpen) {
  // A tube of three rings of three vertices: a ring has no triangle of its own.
  std::vector<std::uint32_t> indices;
  for (std::uint32_t ring = 0; ring < 2; ++ring) {
    for (std::uint32_t n = 0; n < 3; ++n) {
      const std::uint32_t a = 3 * ring + n;
      const std::uint32_t b = 3 * ring + (n + 1) % 3;
      for (const std::uint32_t v : {a, b, b + 3, a, b + 3, a + 3}) indices.push_back(v);
    }
  }
  CollapseMesh mesh = mesh_of(std::vector<Vec3>(9), indices);
  ASSERT_TRUE(mesh.is_free(3));
  EXPECT_FALSE(mesh.keeps_topology(3, 4));
  EXPECT_TRUE(mesh.keeps_topology(3, 0));
}

TEST(CollapseMesh, LeavesNoPillow) {
  const std::vector<std::uint32_t> tetrahedron{0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
  CollapseMesh closed = mesh_of(std::vector<Vec3>(4), tetrahedron);
  ASSERT_TRUE(closed.is_free(0));
  EXPECT_FALSE(closed.keeps_topology(0, 1));
  // Its fourth triangle may lie in another cube.
  const std::vector<std::uint32_t> open{3, 0, 1, 3, 1, 2, 3, 2, 0};
  EXPECT_FALSE(mesh_of(std::vector<Vec3>(4), open, 3).keeps_topology(3, 0));
  EXPECT_TRUE(mesh_of(std::vector<Vec3>(4), open, 0).keeps_topology(3, 0));  // a border
}

TEST(CollapseMesh, JoinsNoVerticesOfTheSeam) {
  const Hexagon hexagon;
  EXPECT_TRUE(hexagon.mesh(1).keeps_topology(6, 0));
  // 0 and 3 are the seam: renumber so that they come first.
  Hexagon other;
  for (std::uint32_t& v : other.indices) v = v == 1 ? 3 : (v == 3 ? 1 : v);
  EXPECT_FALSE(other.mesh(2).keeps_topology(6, 0));
  EXPECT_TRUE(other.mesh(0).keeps_topology(6, 0));
}

TEST(CollapseMesh, RefusesDegenerateTriangles) {
  Hexagon hexagon;
  EXPECT_TRUE(hexagon.mesh().keeps_shape(6, 0));
  hexagon.positions[2] = {0, std::sqrt(0.75), 0};
  hexagon.positions[1] = {0.5, std::sqrt(0.75) / 2, 0};  // between 0 and 2
  hexagon.positions[0] = {1, 0, 0};
  EXPECT_FALSE(hexagon.mesh().keeps_shape(6, 0));
}

TEST(CollapseMesh, RefusesTurnsOfMoreThan75Degrees) {
  // The triangle of 3 and 4 turns about its side by the angle at which 0 rises above the plane.
  const auto keeps = [](double degrees) {
    Hexagon hexagon;
    const double angle = degrees * M_PI / 180;
    const Vec3 middle{-0.75, -std::sqrt(0.75) / 2, 0};
    const Vec3 away{0.5 * std::sqrt(3.0), 0.5, 0};
    for (std::size_t a = 0; a < 3; ++a) {
      hexagon.positions[0][a] = middle[a] + away[a] * std::cos(angle);
    }
    hexagon.positions[0][2] = std::sin(angle);
    // The other triangles are far away and hardly turn.
    CollapseMesh mesh({{0, 0, 0}, {-1, 0, 0}, {-0.5, -std::sqrt(0.75), 0}, hexagon.positions[0]},
                      no_normals(4), std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}, 0);
    return mesh.keeps_shape(0, 3);
  };
  EXPECT_TRUE(keeps(0));
  EXPECT_TRUE(keeps(74));
  EXPECT_FALSE(keeps(76));
  EXPECT_FALSE(keeps(104));
  EXPECT_FALSE(keeps(180));
}

TEST(CollapseMesh, RefusesTrianglesThatComeToFaceAgainstANormal) {
  // A triangle that turns by 20 degrees about the x axis.
  const double angle = 20 * M_PI / 180;
  const auto keeps = [&](std::size_t vertex, const Normal& normal) {
    std::vector<Normal> normals(4, kUp);
    normals[vertex] = normal;
    CollapseMesh mesh({{0, 1, 0}, {-1, 0, 0}, {1, 0, 0}, {0, std::cos(angle), std::sin(angle)}},
                      normals, std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}, 0);
    return mesh.keeps_shape(0, 3);
  };
  const Normal against_new{0, 0.985F, 0.17F};  // 80 degrees from z towards y
  const Normal against_both{0, 0, -1};
  for (const std::size_t vertex : {1U, 2U}) {
    EXPECT_TRUE(keeps(vertex, kUp));
    EXPECT_FALSE(keeps(vertex, against_new));
    EXPECT_TRUE(keeps(vertex, against_both));  // it did before
  }
  EXPECT_FALSE(keeps(3, against_both));  // vertex 0 faced the triangle, its successor does not
}

TEST(CollapseMesh, MovesTheTrianglesOfAVertex) {
  const Hexagon hexagon;
  CollapseMesh mesh = hexagon.mesh();
  mesh.collapse(6, 2);
  EXPECT_EQ(mesh.n_triangles(), 4U);
  std::size_t n = 0;
  mesh.for_corners(2, [&](std::uint32_t corner) {
    EXPECT_FALSE(mesh.is_gone(corner / 4));
    ++n;
  });
  EXPECT_EQ(n, 4U);
}

TEST(CollapseQueue, TakesTheCheapestAndOfEqualOnesTheFirst) {
  CollapseQueue queue(6);
  EXPECT_EQ(queue.take(), CollapseQueue::kNone);
  queue.put(0, 1.0F);
  queue.put(1, 0.5F);
  queue.put(2, 1.01F);  // as 1
  queue.put(3, 0.0F);
  queue.put(4, 3e30F);
  queue.put(5, 0.5F);
  queue.put(0, 1.0F);  // now after 2
  queue.remove(5);
  queue.remove(5);
  for (const std::uint32_t v : {3U, 1U, 2U, 0U, 4U, CollapseQueue::kNone}) {
    EXPECT_EQ(queue.take(), v);
  }
}

TEST(TriangleDistance, IsThatOfTheNearestPoint) {
  const Vec3 a{0, 0, 0};
  const Vec3 b{4, 0, 0};
  const Vec3 c{0, 4, 0};
  const auto expect = [&](const Vec3& p, double square, int far_corner) {
    const NearestPoint nearest = nearest_point(p, a, b, c);
    EXPECT_DOUBLE_EQ(nearest.square, square);
    EXPECT_EQ(nearest.far_corner, far_corner);
  };
  expect({1, 1, 3}, 9, 0);     // inside
  expect({-1, -1, 0}, 2, 0);   // a
  expect({6, -1, 0}, 5, 1);    // b
  expect({-1, 6, 0}, 5, 2);    // c
  expect({2, -3, 0}, 9, 0);    // ab
  expect({-3, 2, 0}, 9, 0);    // ca
  expect({5, 4, 0}, 12.5, 1);  // bc
  expect({4, 5, 0}, 12.5, 2);
}

/// A flat grid of n x n quads, its border on the seam, with one cell's size of 2.
MeshChunk flat_grid(std::uint32_t n, std::size_t& n_seam) {
  const auto is_border = [n](std::uint32_t i, std::uint32_t j) {
    return i == 0 || j == 0 || i == n || j == n;
  };
  MeshChunk mesh;
  std::vector<std::uint32_t> number((n + 1) * (n + 1));
  std::uint32_t next = 0;
  for (const bool border : {true, false}) {
    for (std::uint32_t j = 0; j <= n; ++j) {
      for (std::uint32_t i = 0; i <= n; ++i) {
        if (is_border(i, j) != border) continue;
        number[j * (n + 1) + i] = next++;
        for (const float x : {2.F * float(i), 2.F * float(j), 7.F}) mesh.positions.push_back(x);
      }
    }
    if (border) n_seam = next;
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t* at = &number[j * (n + 1) + i];
      for (const std::uint32_t v : {at[0], at[1], at[n + 2], at[0], at[n + 2], at[n + 1]}) {
        mesh.indices.push_back(v);
      }
    }
  }
  return mesh;
}

TEST(Simplify, LeavesOfAFlatSquareLittleButItsSeam) {
  std::size_t n_seam = 0;
  MeshChunk mesh = flat_grid(20, n_seam);
  const MeshChunk before = mesh;
  MeshCube cube{mesh, {}, n_seam, 2, 800, 800, true};
  Simplify({.by = SimplifyGoal::By::error, .error = 0.01}).apply(cube);
  EXPECT_LT(mesh.n_vertices(), n_seam + 20);
  EXPECT_EQ(mesh.n_triangles(), 2 * mesh.n_vertices() - 2 - n_seam);  // Euler's formula
  EXPECT_TRUE(std::equal(mesh.positions.begin(),
                         mesh.positions.begin() + static_cast<std::ptrdiff_t>(3 * n_seam),
                         before.positions.begin()));
  EXPECT_EQ(cube.distances.n, before.n_vertices());
  EXPECT_NEAR(cube.distances.max, 0, 1e-9);
}

TEST(Simplify, StopsAtItsGoal) {
  std::size_t n_seam = 0;
  const MeshChunk before = flat_grid(20, n_seam);
  const auto simplified = [&](const SimplifyGoal& goal, bool is_last_pass) {
    MeshChunk mesh = before;
    MeshCube cube{mesh, {}, n_seam, 2, 1000, 4000, is_last_pass};
    Simplify(goal).apply(cube);
    return mesh.n_triangles();
  };
  using By = SimplifyGoal::By;
  EXPECT_EQ(simplified({.by = By::ratio, .ratio = 0.6}, true), 600U);  // of those extracted
  EXPECT_EQ(simplified({.by = By::count, .count = 2400}, true), 600U);
  EXPECT_EQ(simplified({.by = By::ratio, .ratio = 1}, true), 800U);
  // In the first pass, of 361 vertices that may go, 66 % remain.
  EXPECT_EQ(simplified({.by = By::ratio, .ratio = 0.6}, false), 800U - 2 * 122U);
}

TEST(Simplify, MeasuresDistancesInTheWorld) {
  std::size_t n_seam = 0;
  MeshChunk mesh = flat_grid(20, n_seam);
  for (std::size_t v = n_seam; v < mesh.n_vertices(); ++v) {
    const float x = mesh.positions[3 * v] - 20;
    const float y = mesh.positions[3 * v + 1] - 20;
    mesh.positions[3 * v + 2] += std::max(0.F, 100 - x * x - y * y) / 20;
  }
  MeshChunk scaled = mesh;
  for (float& x : scaled.positions) x *= 8;
  const Simplify simplify({.by = SimplifyGoal::By::ratio, .ratio = 0.3});
  MeshCube cube{mesh, {}, n_seam, 2, 800, 800, true};
  simplify.apply(cube);
  MeshCube large{scaled, {}, n_seam, 16, 800, 800, true};
  simplify.apply(large);
  EXPECT_EQ(scaled.indices, mesh.indices);
  EXPECT_GT(cube.distances.max, 0.01);
  EXPECT_LT(cube.distances.max, 1);
  EXPECT_DOUBLE_EQ(large.distances.max, 8 * cube.distances.max);
  EXPECT_DOUBLE_EQ(large.distances.sum_squares, 64 * cube.distances.sum_squares);
}

}  // namespace
}  // namespace mc::process
