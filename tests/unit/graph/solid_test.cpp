// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "unit/graph/graph_support.hpp"

// The solids as distances: hand-counted values, slope 1, volumes; offset and shell.

namespace mc::tests {
namespace {

struct Solid {
  const char* name;
  Node node;
  double volume;  // 0: not known
};

Node solid(NodeType type, std::array<float, 6> numbers, std::vector<float> list = {},
           std::uint8_t axis = 1) {
  Node node = make(type, {}, numbers);
  node.list = std::move(list);
  node.axis = axis;
  return node;
}

std::vector<Solid> exact_solids() {
  constexpr double kPi = std::numbers::pi;
  // A ball of radius r moved along the edges of a box of sizes a, b, c.
  const auto rounded = [&](double a, double b, double c, double r) {
    return a * b * c + 2 * r * (a * b + b * c + c * a) + kPi * r * r * (a + b + c) +
           4 * kPi / 3 * r * r * r;
  };
  return {
      {"sphere", solid(NodeType::sphere, {0.5F, 0, -0.5F, 2}), 4 * kPi / 3 * 8},
      {"box", solid(NodeType::box, {0.5F, -0.25F, 0, 3, 4, 5}), 60},
      {"torus", solid(NodeType::torus, {0, 0.5F, 0, 2, 0.75F}, {}, 2), 2 * kPi * kPi * 2 * 0.5625},
      {"roundbox", solid(NodeType::roundbox, {0.25F, 0, 0, 4, 3, 5}, {0.75F}),
       rounded(2.5, 1.5, 3.5, 0.75)},
      {"cylinder", solid(NodeType::cylinder, {0, 0.5F, 0, 1.5F, 4}, {}, 0), kPi * 2.25 * 4},
      {"cone", solid(NodeType::cone, {0, 0, 0.5F, 2, 0, 3}), kPi * 4 * 3 / 3},
      {"blunt cone", solid(NodeType::cone, {0, 0, 0.5F, 0.5F, 2, 3}, {}, 2),
       kPi * 3 / 3 * (0.25 + 1 + 4)},
      {"capsule", solid(NodeType::capsule, {}, {-1, -1, 0, 1, 1, 1, 1, 1}), kPi * 3 + 4 * kPi / 3},
      {"upright capsule", solid(NodeType::capsule, {}, {0, -1, 0, 0, 2, 0, 1, 1}),
       kPi * 3 + 4 * kPi / 3},
      {"tapered capsule", solid(NodeType::capsule, {}, {0, -1, 0, 0, 1, 0, 1.8F, 0.6F}), 0},
  };
}

TEST(SolidDistances, HaveSlopeOne) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-3.9, 3.9);
  for (const Solid& s : exact_solids()) {
    Graph graph({});
    const NodeId id = graph.add(s.node);
    const GraphField field = graph.compile(id);
    constexpr double kStep = 1.0 / 64;
    int n_level = 0;
    constexpr int kPoints = 4000;
    for (int n = 0; n < kPoints; ++n) {
      const Vec3 p{place(random), place(random), place(random)};
      double slope2 = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec3 low = p;
        low[axis] -= kStep;
        Vec3 spacing{1, 1, 1};
        spacing[axis] = 2 * kStep;
        Index3 dims{1, 1, 1};
        dims[axis] = 2;
        const auto pair = sampled(graph, id, low, spacing, dims);
        slope2 += std::pow((pair[1] - pair[0]) / (2 * kStep), 2);
      }
      const double slope = std::sqrt(slope2);
      ASSERT_LT(slope, 1.001) << s.name << " at " << p[0] << ' ' << p[1] << ' ' << p[2];
      n_level += slope < 0.998 ? 1 : 0;  // near an edge, or as near to one side as to another
    }
    EXPECT_LT(n_level, kPoints * 5 / 100) << s.name;
  }
}

/// A cell that the surface cuts counts by its centre's distance: of second order in the spacing.
double volume_of(const Node& node, Convention convention) {
  constexpr std::int32_t kSide = 128;
  constexpr double kSpacing = 8.0 / kSide;
  constexpr float kIso = 0.25F;
  Graph graph({.convention = convention, .iso = kIso});
  const double first = -4 + kSpacing / 2;
  const auto values = sampled(graph, graph.add(node), {first, first, first},
                              {kSpacing, kSpacing, kSpacing}, {kSide, kSide, kSide});
  double volume = 0;
  for (const float v : values) {
    const double inside = convention == Convention::density ? v - kIso : kIso - v;
    volume += std::clamp(0.5 + inside / kSpacing, 0.0, 1.0);
  }
  return volume * kSpacing * kSpacing * kSpacing;
}

TEST(SolidDistances, EncloseTheRightVolumeUnderBothConventions) {
  for (const Solid& s : exact_solids()) {
    if (s.volume > 0) {
      EXPECT_NEAR(volume_of(s.node, Convention::density), s.volume, 0.003 * s.volume) << s.name;
      EXPECT_NEAR(volume_of(s.node, Convention::sdf), s.volume, 0.003 * s.volume) << s.name;
    }
  }
  const Node egg = solid(NodeType::ellipsoid, {0.5F, 0, 0, 1, 2, 3});
  const double egg_volume = 4 * std::numbers::pi / 3 * 6;
  EXPECT_NEAR(volume_of(egg, Convention::density), egg_volume, 0.003 * egg_volume);
  // The gyroid halves space, and a thin sheet's area is 3.0915 a cube of its period.
  const Node half = solid(NodeType::gyroid, {0, 0, 0, 4});
  EXPECT_NEAR(volume_of(half, Convention::density), 256, 0.5);
  const Node sheet = solid(NodeType::gyroid, {0, 0, 0, 4, 0.1F});
  EXPECT_NEAR(volume_of(sheet, Convention::density), 8 * 3.0915 * 16 * 0.1, 0.2);
}

float density_at(const Node& node, const Vec3& p) {
  Graph graph({});
  return value_at(graph, graph.add(node), p);
}

TEST(SolidDistances, AreTheseByHand) {
  const Node box = solid(NodeType::roundbox, {0, 0, 0, 4, 4, 4}, {1});
  EXPECT_EQ(density_at(box, {0, 0, 0}), 2.0F);
  EXPECT_EQ(density_at(box, {4, 5, 0}), -4.0F);  // (3, 4) from the rounding's centre, less 1
  const Node cylinder = solid(NodeType::cylinder, {1, 0, 0, 2, 6});
  EXPECT_EQ(density_at(cylinder, {1, 0, 0}), 2.0F);
  EXPECT_EQ(density_at(cylinder, {1, 4, 0}), -1.0F);
  EXPECT_EQ(density_at(cylinder, {6, 7, 0}), -5.0F);  // (3, 4) from the rim
  const Node cone = solid(NodeType::cone, {0, 0, 0, 3, 0, 4});
  EXPECT_EQ(density_at(cone, {0, 4, 0}), -2.0F);           // over the tip
  EXPECT_FLOAT_EQ(density_at(cone, {0, -1, 0}), 1.0F);     // the base is nearer
  EXPECT_FLOAT_EQ(density_at(cone, {5.5F, 3, 0}), -5.0F);  // from the slope's middle (1.5, 0)
  EXPECT_FLOAT_EQ(density_at(cone, {6, -6, 0}), -5.0F);    // (3, 4) from the rim
  const Node capsule = solid(NodeType::capsule, {}, {0, 0, 0, 0, 0, 4, 1, 1});
  EXPECT_EQ(density_at(capsule, {0, 0, 2}), 1.0F);
  EXPECT_EQ(density_at(capsule, {3, 0, 2}), -2.0F);
  EXPECT_EQ(density_at(capsule, {0, 3, 8}), -4.0F);
  const Node tapered = solid(NodeType::capsule, {}, {0, 0, 0, 0, 5, 0, 4, 1});  // sine 3/5
  EXPECT_EQ(density_at(tapered, {0, -6, 0}), -2.0F);
  EXPECT_EQ(density_at(tapered, {0, 8, 0}), -2.0F);
  EXPECT_FLOAT_EQ(density_at(tapered, {4.0F, 3, 0}), -1.0F);  // 4 - (4 * 0.8 + 3 * 0.6)
  const Node swallowed = solid(NodeType::capsule, {}, {0, 0, 0, 0, 1, 0, 1, 3});
  EXPECT_EQ(density_at(swallowed, {0, 1, 0}), 3.0F);
  EXPECT_EQ(density_at(swallowed, {0, 1, 5}), -2.0F);
  const Node egg = solid(NodeType::ellipsoid, {0, 0, 0, 1, 2, 4});
  EXPECT_EQ(density_at(egg, {0, 0, 0}), 1.0F);  // has no slope there: the least radius
  EXPECT_EQ(density_at(egg, {0, 3, 0}), -1.0F);
  EXPECT_EQ(density_at(egg, {0, 0, 4}), 0.0F);
}

TEST(SolidDistances, OfNanAreNan) {
  for (Solid s : exact_solids()) {
    Graph graph({});
    const NodeId zero = graph.add(make(NodeType::constant));
    const NodeId nan = graph.add(make(NodeType::div, {zero, zero}));
    const NodeId id = graph.add(s.node);
    const NodeId nowhere = graph.add(make(NodeType::warp, {id, nan}, {1}));
    EXPECT_TRUE(std::isnan(value_at(graph, nowhere, {1, 2, 3}))) << s.name;
  }
}

TEST(Gyroid, IsPeriodicAndItsSheetLiesOnBothSides) {
  const Node half = solid(NodeType::gyroid, {1, 0, 0, 4});
  EXPECT_EQ(density_at(half, {1, 0, 0}), 0.0F);
  EXPECT_NEAR(density_at(half, {1.3F, 0.4F, 0.2F}), density_at(half, {5.3F, -3.6F, 8.2F}), 2e-6);
  EXPECT_NEAR(density_at(half, {1.01F, 0, 0}), 0.01F / std::numbers::sqrt3_v<float>, 1e-5);
  Node sheet = half;
  sheet.numbers[4] = 0.5F;
  EXPECT_EQ(density_at(sheet, {1, 0, 0}), 0.25F);
  EXPECT_LT(density_at(sheet, {1.5F, 0, 0}), 0.0F);
  EXPECT_LT(density_at(sheet, {0.5F, 0, 0}), 0.0F);
}

class OffsetAndShell : public testing::TestWithParam<Convention> {
 protected:
  /// Depth below the surface of a ball of radius 5 after `type`, `distance` from its centre.
  float depth(NodeType type, std::array<float, 6> numbers, double distance) {
    const bool density = GetParam() == Convention::density;
    Graph graph({.convention = GetParam(), .iso = 3});
    const NodeId ball = graph.add(make(NodeType::sphere, {}, {0, 0, 0, 5}));
    const float v = value_at(graph, graph.add(make(type, {ball}, numbers)), {distance, 0, 0});
    return density ? v - 3 : 3 - v;
  }
};

INSTANTIATE_TEST_SUITE_P(Both, OffsetAndShell,
                         testing::Values(Convention::density, Convention::sdf));

TEST_P(OffsetAndShell, FollowTheConventionAndItsIso) {
  EXPECT_EQ(depth(NodeType::offset, {2}, 5), 2.0F);
  EXPECT_EQ(depth(NodeType::offset, {-2}, 1), 2.0F);
  // thickness, depth of its middle: below the surface, on it, above it
  EXPECT_EQ(depth(NodeType::shell, {2, 1}, 4), 1.0F);
  EXPECT_EQ(depth(NodeType::shell, {2, 1}, 5), 0.0F);
  EXPECT_EQ(depth(NodeType::shell, {2, 1}, 0), -3.0F);
  EXPECT_EQ(depth(NodeType::shell, {2, 0}, 5), 1.0F);
  EXPECT_EQ(depth(NodeType::shell, {2, 0}, 7), -1.0F);
  EXPECT_EQ(depth(NodeType::shell, {2, -1}, 6), 1.0F);
  EXPECT_EQ(depth(NodeType::shell, {2, -1}, 4.5), -0.5F);
}

}  // namespace
}  // namespace mc::tests
