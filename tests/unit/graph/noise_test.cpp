// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "unit/graph/graph_support.hpp"

// The noises: Unity's values, ranges, continuity, seeds, coordinates that are no numbers.

namespace mc::tests {
namespace {

float unity(double x, double y) {
  Graph graph({});
  const NodeId node = graph.add(make(NodeType::unity_perlin2d, {}, {1}));
  return value_at(graph, node, {x, 0, y});
}

TEST(UnityPerlin, GivesUnitysValuesToTheLastBit) {
  EXPECT_EQ(unity(0, 0), 0.465273082F);
  EXPECT_EQ(unity(17, -300), 0.465273082F);
  EXPECT_EQ(unity(0.5, 0.5), 0.296695888F);
  EXPECT_EQ(unity(12.3, 45.6), 0.36651063F);
  EXPECT_EQ(unity(3.25, 1.75), 0.50739938F);
  EXPECT_EQ(unity(-3.25, 1.75), 0.50739938F);
}

TEST(UnityPerlin, RepeatsAfter256Cells) { EXPECT_EQ(unity(0.5, 0.25), unity(256.5, 512.25)); }

struct Noise {
  NodeType type;
  Dims dims;
};

class Noises : public testing::TestWithParam<Noise> {
 protected:
  static Node node(std::uint32_t seed = 0) {
    Node made = make(GetParam().type, {}, {1});
    made.dims = GetParam().dims;
    made.seed = seed;
    return made;
  }
};

INSTANTIATE_TEST_SUITE_P(All, Noises,
                         testing::Values(Noise{NodeType::perlin, Dims::xyz},
                                         Noise{NodeType::perlin, Dims::xz},
                                         Noise{NodeType::simplex, Dims::xyz},
                                         Noise{NodeType::simplex, Dims::xz}));

TEST_P(Noises, StayWithinOneAndUseMostOfIt) {
  Graph graph({});
  const auto values =
      sampled(graph, graph.add(node()), {-20.03, -11.4, 3.7}, {0.23, 0.19, 0.21}, {97, 64, 97});
  const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
  EXPECT_GE(*lo, -1.0F);
  EXPECT_LE(*hi, 1.0F);
  EXPECT_LT(*lo, -0.6F);
  EXPECT_GT(*hi, 0.6F);
}

TEST_P(Noises, AreContinuous) {
  Graph graph({});
  const NodeId id = graph.add(node());
  for (const Vec3 start : {Vec3{-3, 0.37, 1.21}, Vec3{0.11, -2.5, -3}, Vec3{-2, -2, -2}}) {
    // A step of 1/1024 along each axis at once crosses borders of cells and simplices; the
    // steepest slope is below 8.
    const GraphField field = graph.compile(id);
    float last = value_at(graph, id, start);
    for (int n = 1; n < 6000; ++n) {
      const double t = n / 1024.0;
      const float now = value_at(graph, id, {start[0] + t, start[1] + 0.7 * t, start[2] + 0.9 * t});
      ASSERT_LT(std::abs(now - last), 8.0 * 1.6 / 1024) << "at step " << n;
      last = now;
    }
  }
}

TEST_P(Noises, SeedsOfNodeAndDocumentChangeThem) {
  Graph zero({});
  Graph one({.seed = 1});
  const Vec3 at{0.4, 0.3, 0.2};
  const float base = value_at(zero, zero.add(node()), at);
  EXPECT_EQ(value_at(zero, zero.add(node()), at), base);
  EXPECT_NE(value_at(zero, zero.add(node(1)), at), base);
  EXPECT_NE(value_at(one, one.add(node()), at), base);
}

TEST_P(Noises, HugeCoordinatesAreHeldAndNanStaysNan) {
  Graph graph({});
  const NodeId id = graph.add(node());
  for (const double far : {1e9, -1e12, 3e38}) {
    const float v = value_at(graph, id, {far, far, far});
    EXPECT_LE(std::abs(v), 1.0F) << far;
  }
  const NodeId zero = graph.add(make(NodeType::constant));
  Node nowhere = make(NodeType::warp, {id, graph.add(make(NodeType::div, {zero, zero}))}, {1});
  EXPECT_TRUE(std::isnan(value_at(graph, graph.add(nowhere), {1, 2, 3})));
}

TEST(Dims, TwoDimensionalNoiseIgnoresTheThirdCoordinate) {
  Graph graph({});
  Node perlin = make(NodeType::perlin, {}, {1});
  perlin.dims = Dims::xz;
  const NodeId id = graph.add(perlin);
  EXPECT_EQ(value_at(graph, id, {0.3, 0, 0.7}), value_at(graph, id, {0.3, 55.5, 0.7}));
  EXPECT_NE(value_at(graph, id, {0.3, 0, 0.7}), value_at(graph, id, {0.3, 0, 0.8}));
}

TEST(Fbm, OneOctaveIsItsSourceAndDimsPassDown) {
  Graph graph({});
  const NodeId source = graph.add(make(NodeType::perlin, {}, {0.5F}));
  Node fbm = make(NodeType::fbm, {source}, {2, 0.5F, 0});
  EXPECT_EQ(value_at(graph, graph.add(fbm), {0.3, 1.2, 5.1}),
            value_at(graph, source, {0.3, 1.2, 5.1}));
  fbm.dims = Dims::xz;
  const NodeId flat = graph.add(fbm);
  EXPECT_EQ(value_at(graph, flat, {0.3, 1.2, 5.1}), value_at(graph, flat, {0.3, 7.7, 5.1}));
}

TEST(Fbm, IsTheWeightedSumOfItsOctaves) {
  Graph graph({});
  const NodeId x = graph.add(make(NodeType::x));  // octave n of x is x * 2^n
  Node fbm = make(NodeType::fbm, {x}, {2, 0.25F, 0});
  fbm.octaves = 3;
  // (x + 2x/4 + 4x/16) / (1 + 1/4 + 1/16)
  EXPECT_FLOAT_EQ(value_at(graph, graph.add(fbm), {3, 0, 0}), 3 * 1.75F / 1.3125F);
  fbm.numbers[2] = 1;  // the first octave is 1 or more: amplitudes are not weakened
  EXPECT_FLOAT_EQ(value_at(graph, graph.add(fbm), {3, 0, 0}), 3 * 1.75F / 1.3125F);
  // x = -1: the first octave is as low as can be, the later ones vanish.
  EXPECT_FLOAT_EQ(value_at(graph, graph.add(fbm), {-1, 0, 0}), -1 / 1.3125F);
}

TEST(Warp, MovesTheCoordinatesOfItsSource) {
  Graph graph({});
  const NodeId x = graph.add(make(NodeType::x));
  const NodeId half = graph.add(make(NodeType::constant, {}, {0.5F}));
  const NodeId warp = graph.add(make(NodeType::warp, {x, half}, {18}));
  EXPECT_EQ(value_at(graph, warp, {3, 0, 0}), 12.0F);
}

}  // namespace
}  // namespace mc::tests
