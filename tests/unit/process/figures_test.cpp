// SPDX-License-Identifier: MIT
#include "process/figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace mc::process {
namespace {

double sum_of(const std::vector<double>& values) {
  ExactSum sum;
  for (const double v : values) sum.add(v);
  return sum.value();
}

TEST(ExactSum, LosesNothing) {
  EXPECT_EQ(sum_of({}), 0);
  EXPECT_EQ(sum_of({1e300, 1, -1e300}), 1);
  EXPECT_EQ(sum_of({-1e300, -1, 1e300}), -1);
  constexpr double kMin = std::numeric_limits<double>::denorm_min();
  constexpr double kMax = std::numeric_limits<double>::max();
  EXPECT_EQ(sum_of({kMax, kMin, -kMax}), kMin);
  EXPECT_EQ(sum_of({kMax, kMax, -kMax}), kMax);
  EXPECT_EQ(sum_of({kMax, kMax}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(sum_of({0.1}), 0.1);
  EXPECT_EQ(sum_of({-0.1, -0.25}), -0.35);
  EXPECT_EQ(sum_of({std::ldexp(1, 31), std::ldexp(1, 32), std::ldexp(1, 33)}), std::ldexp(7, 31));
  EXPECT_TRUE(std::isnan(sum_of({1, std::numeric_limits<double>::infinity()})));
}

TEST(ExactSum, IsTheSameForAnyOrderAndGrouping) {
  std::mt19937_64 random(3);
  std::vector<double> values;
  for (int n = 0; n < 1000; ++n) {
    values.push_back(std::ldexp(static_cast<double>(random() % 2001) - 1000,
                                static_cast<int>(random() % 200) - 100));
  }
  const double whole = sum_of(values);
  std::ranges::shuffle(values, random);
  EXPECT_EQ(sum_of(values), whole);
  ExactSum grouped;
  for (std::size_t first = 0; first < values.size(); first += 7) {
    ExactSum group;
    for (std::size_t n = first; n < std::min(first + 7, values.size()); ++n) group.add(values[n]);
    grouped.add(group);
  }
  EXPECT_EQ(grouped.value(), whole);
}

/// A unit cube's corner: three of its tetrahedron's faces, or all four.
MeshChunk tetrahedron(bool closed) {
  MeshChunk mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  mesh.indices = {0, 2, 1, 0, 1, 3, 0, 3, 2};
  if (closed) mesh.indices.insert(mesh.indices.end(), {1, 2, 3});
  return mesh;
}

TEST(Figures, OfATetrahedron) {
  MeshChunk mesh = tetrahedron(true);
  const MeshWindow window{mesh, {}, {0, 4}, {0, 4}};
  const SurfaceSums sums = own_sums(window, {5, -3, 2});
  EXPECT_DOUBLE_EQ(sums.area.value(), 1.5 + std::sqrt(0.75));
  EXPECT_DOUBLE_EQ(sums.volume.value(), 1.0 / 6);
  EXPECT_EQ(own_boundary_edges(window), 0U);
  EXPECT_EQ(bounds_of(mesh).lo, (Vec3{0, 0, 0}));
  EXPECT_EQ(bounds_of(mesh).hi, (Vec3{1, 1, 1}));
}

TEST(Figures, EachBoundaryEdgeBelongsToItsFirstVertex) {
  MeshChunk mesh = tetrahedron(false);
  EXPECT_EQ(own_boundary_edges({mesh, {}, {0, 4}, {}}), 3U);
  EXPECT_EQ(own_boundary_edges({mesh, {}, {0, 1}, {}}), 0U);
  EXPECT_EQ(own_boundary_edges({mesh, {}, {1, 2}, {}}), 2U);
  EXPECT_EQ(own_boundary_edges({mesh, {}, {2, 4}, {}}), 1U);
}

}  // namespace
}  // namespace mc::process
