// SPDX-License-Identifier: MIT
#include "mc/components.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "mc/mesh.hpp"

namespace mc::test {
namespace {

using Kept = std::vector<std::uint8_t>;

/// A cube from `lo` to `hi` along each axis; turned inside out if lo > hi.
void add_cube(Mesh& mesh, float lo, float hi, float x = 0) {
  const std::uint64_t first = mesh.n_vertices();
  for (int c = 0; c < 8; ++c) {
    mesh.positions.push_back(
        {x + ((c & 1) != 0 ? hi : lo), (c & 2) != 0 ? hi : lo, (c & 4) != 0 ? hi : lo});
  }
  constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : kFaces) {
    const auto id = [&](int n) { return first + static_cast<std::uint64_t>(f[n]); };
    mesh.add_triangle({id(0), id(1), id(2)});
    mesh.add_triangle({id(0), id(2), id(3)});
  }
}

TEST(SelectComponents, KeepsTheLargest) {
  const std::vector<double> sizes{3, 7, 5, 7.5};
  EXPECT_EQ(select_components(sizes, {}), (Kept{0, 0, 0, 1}));
  EXPECT_EQ(select_components(sizes, {.n = 3}), (Kept{0, 1, 1, 1}));
  EXPECT_EQ(select_components(sizes, {.n = 9}), (Kept{1, 1, 1, 1}));
}

TEST(SelectComponents, PrefersTheFirstOfEqualSizes) {
  const double a = 1.7;
  EXPECT_EQ(select_components(std::vector{a, a * (1 + 1e-12), a}, {}), (Kept{1, 0, 0}));
  EXPECT_EQ(select_components(std::vector{a, a * (1 + 1e-5), a}, {}), (Kept{0, 1, 0}));
}

TEST(SelectComponents, KeepsAllThatAreLargeEnough) {
  const KeepRule rule{.by = KeepRule::By::volume, .min_size = 5};
  EXPECT_EQ(select_components(std::vector{5.0, 4.9, HUGE_VAL}, rule), (Kept{1, 0, 1}));
  EXPECT_TRUE(select_components({}, rule).empty());
}

TEST(MeshComponents, CountACavityToTheSolidAroundIt) {
  Mesh mesh;
  add_cube(mesh, 0, 10);
  add_cube(mesh, 7, 3);       // a cavity
  add_cube(mesh, 4, 6);       // a solid in it
  add_cube(mesh, 0, 10, 20);  // a solid with two cavities in line
  add_cube(mesh, 4, 2, 20);
  add_cube(mesh, 8, 6, 20);
  const MeshComponents found = find_components(mesh);
  ASSERT_EQ(found.volumes.size(), 3U);
  EXPECT_DOUBLE_EQ(found.volumes[0], 1000 - 64);
  EXPECT_DOUBLE_EQ(found.volumes[1], 8);
  EXPECT_DOUBLE_EQ(found.volumes[2], 1000 - 16);
  EXPECT_DOUBLE_EQ(found.areas[1], 24);
  EXPECT_EQ(found.of_vertex[8], 0U);
  EXPECT_EQ(found.of_vertex[16], 1U);
  EXPECT_EQ(keep_components(mesh, {}), (ComponentCounts{3, 1}));
  EXPECT_EQ(mesh.n_vertices(), 24U);
  EXPECT_EQ(mesh.n_triangles(), 36U);
  EXPECT_EQ(check_mesh(mesh).components, 3U);
}

TEST(MeshComponents, CloseAnOpenShellByAFan) {
  Mesh mesh;
  add_cube(mesh, 0, 2);
  mesh.triangles.resize(10);  // without the side at x = 2
  const MeshComponents found = find_components(mesh);
  ASSERT_EQ(found.volumes.size(), 1U);
  EXPECT_DOUBLE_EQ(found.volumes[0], 8);
  EXPECT_DOUBLE_EQ(found.areas[0], 20);
}

TEST(MeshComponents, DropVerticesWithoutTriangles) {
  Mesh mesh;
  mesh.positions.push_back({9, 9, 9});
  add_cube(mesh, 0, 1);
  mesh.attributes.push_back({.info = {"number", SampleType::u8, 1}, .values = {}});
  for (int v = 0; v < 9; ++v) mesh.attributes[0].values.push_back(std::byte(v));
  EXPECT_EQ(find_components(mesh).of_vertex[0], MeshComponents::kNone);
  keep_components(mesh, {});
  ASSERT_EQ(mesh.attributes[0].values.size(), 8U);
  EXPECT_EQ(mesh.attributes[0].values[0], std::byte{1});
  EXPECT_EQ(mesh.n_vertices(), 8U);
  EXPECT_EQ(mesh.triangle(0)[0], 0U);
}

}  // namespace
}  // namespace mc::test
