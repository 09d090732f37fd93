// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

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
  bool smooth = true;
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

INSTANTIATE_TEST_SUITE_P(
    All, Noises,
    testing::Values(Noise{NodeType::perlin, Dims::xyz}, Noise{NodeType::perlin, Dims::xz},
                    Noise{NodeType::simplex, Dims::xyz}, Noise{NodeType::simplex, Dims::xz},
                    Noise{NodeType::opensimplex2, Dims::xyz},
                    Noise{NodeType::opensimplex2, Dims::xz}, Noise{NodeType::value, Dims::xyz},
                    Noise{NodeType::value, Dims::xz}, Noise{NodeType::value_cubic, Dims::xyz},
                    Noise{NodeType::value_cubic, Dims::xz},
                    Noise{NodeType::white, Dims::xyz, false},
                    Noise{NodeType::white, Dims::xz, false}));

TEST_P(Noises, StayWithinOneAndUseMostOfIt) {
  Graph graph({});
  const auto values =
      sampled(graph, graph.add(node()), {-20.03, -11.4, 3.7}, {0.23, 0.19, 0.21}, {97, 64, 97});
  const auto [lo, hi] = std::minmax_element(values.begin(), values.end());
  EXPECT_GE(*lo, -1.0F);
  EXPECT_LE(*hi, 1.0F);
  EXPECT_LT(*lo, -0.6F);
  EXPECT_GT(*hi, 0.6F);
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  EXPECT_LT(std::abs(sum) / static_cast<double>(values.size()), 0.03);
}

TEST_P(Noises, AreContinuous) {
  if (!GetParam().smooth) return;  // white noise
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

Node cellular(CellReturn what, CellMetric metric = CellMetric::euclidean, float jitter = 1) {
  Node node = make(NodeType::cellular, {}, {1, jitter});
  node.cell_return = what;
  node.cell_metric = metric;
  return node;
}

// A distance changes by no more than the way walked, also where cells change: none is overlooked.
TEST(Cellular, DistancesAreAsSteepAsTheMetric) {
  for (const Dims dims : {Dims::xz, Dims::xyz}) {
    for (const CellReturn what : {CellReturn::f1, CellReturn::f2}) {
      for (const CellMetric metric :
           {CellMetric::euclidean, CellMetric::manhattan, CellMetric::chebyshev}) {
        Graph graph({});
        Node node = cellular(what, metric);
        node.dims = dims;
        const auto values =
            sampled(graph, graph.add(node), {-30, 0.3, 0.7}, {1.0 / 512, 1, 1}, {30000, 1, 1});
        for (std::size_t n = 1; n < values.size(); ++n) {
          ASSERT_LE(std::abs(values[n] - values[n - 1]), 1.001F / 512) << n;
        }
      }
    }
  }
}

TEST(Cellular, WithoutJitterMeasuresToTheMiddlesOfCells) {
  Graph graph({});
  const Vec3 at{2.75, -1.5, 0.5};
  const auto value = [&](CellReturn what, CellMetric metric) {
    return value_at(graph, graph.add(cellular(what, metric, 0)), at);
  };
  EXPECT_EQ(value(CellReturn::f1, CellMetric::euclidean), 0.25F);
  EXPECT_EQ(value(CellReturn::f2, CellMetric::manhattan), 0.75F);
  EXPECT_EQ(value(CellReturn::f2_f1, CellMetric::chebyshev), 0.5F);
}

TEST(Cellular, ValueIsOneNumberInACell) {
  Graph graph({});
  const NodeId id = graph.add(cellular(CellReturn::value, CellMetric::euclidean, 0));
  const float here = value_at(graph, id, {0.1, 0.2, 0.3});
  EXPECT_EQ(value_at(graph, id, {0.9, 0.8, 0.7}), here);
  EXPECT_NE(value_at(graph, id, {1.1, 0.8, 0.7}), here);
  EXPECT_LE(std::abs(here), 1.0F);
}

TEST(White, IsOneNumberAroundALatticePoint) {
  Graph graph({});
  const NodeId id = graph.add(make(NodeType::white, {}, {1}));
  EXPECT_EQ(value_at(graph, id, {2.4, 0, 0}), value_at(graph, id, {1.6, 0.4, -0.4}));
  EXPECT_NE(value_at(graph, id, {2.6, 0, 0}), value_at(graph, id, {2.4, 0, 0}));
}

// Neighbours have nothing to do with each other, along any axis.
TEST(White, IsNotCorrelated) {
  Graph graph({.seed = 9});
  constexpr std::int32_t kSide = 64;
  const auto values = sampled(graph, graph.add(make(NodeType::white, {}, {1})), {-32, -32, -32},
                              {1, 1, 1}, {kSide, kSide, kSide});
  for (const std::size_t step : {1U, unsigned{kSide}, unsigned{kSide * kSide}}) {
    double sum = 0;
    for (std::size_t n = step; n < values.size(); ++n) {
      sum += double{values[n]} * double{values[n - step]};
    }
    EXPECT_LT(std::abs(sum) / static_cast<double>(values.size()), 0.003) << step;
  }
}

TEST(ValueNoises, PassThroughTheSameValuesAtLatticePoints) {
  Graph graph({});
  const NodeId white = graph.add(make(NodeType::white, {}, {1}));
  const NodeId value = graph.add(make(NodeType::value, {}, {1}));
  const NodeId cubic = graph.add(make(NodeType::value_cubic, {}, {1}));
  for (const Vec3 at : {Vec3{0, 0, 0}, Vec3{3, -4, 5}, Vec3{-7, 1, 2}}) {
    EXPECT_EQ(value_at(graph, value, at), value_at(graph, white, at));
    EXPECT_EQ(value_at(graph, cubic, at), value_at(graph, white, at) * 0.512F);
  }
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

TEST(Fractals, FoldTheirOctaves) {
  Graph graph({});
  const NodeId x = graph.add(make(NodeType::x));
  const auto at = [&](NodeType type, double place) {
    Node node = make(type, {x}, {2, 0.5F, 0, 2});
    node.octaves = 2;
    return value_at(graph, graph.add(node), {place, 0, 0});
  };
  // Octaves x = 1/4 and 2x = 1/2, of weights 2/3 and 1/3.
  EXPECT_FLOAT_EQ(at(NodeType::ridged, 0.25), (2 * 0.5F + 0.0F) / 3);
  EXPECT_FLOAT_EQ(at(NodeType::billow, 0.25), (2 * -0.5F + 0.0F) / 3);
  // (1/4 + 1) 2 = 2.5 and (1/2 + 1) 2 = 3: half way up, and at the top.
  EXPECT_FLOAT_EQ(at(NodeType::pingpong, 0.25), (2 * 0.0F + 1.0F) / 3);
}

TEST(Fractals, WeightedOnesFollowTheFoldedOctave) {
  Graph graph({});
  const NodeId x = graph.add(make(NodeType::x));
  Node node = make(NodeType::ridged, {x}, {2, 0.5F, 1});
  node.octaves = 2;
  // Ridge 1/2, so level 3/4: the second octave's amplitude is 3/8; its ridge is 0.
  EXPECT_FLOAT_EQ(value_at(graph, graph.add(node), {0.25, 0, 0}), 0.5F / 1.5F);
  // Ridge -1, level 0: nothing follows.
  EXPECT_FLOAT_EQ(value_at(graph, graph.add(node), {1, 0, 0}), -1.0F / 1.5F);
}

TEST(Warp, ModesDifferInWhereOctavesAreTaken) {
  Graph graph({});
  const NodeId x = graph.add(make(NodeType::x));
  const auto at = [&](WarpMode mode) {
    Node node = make(NodeType::warp, {x, x}, {3, 2, 0.5F});
    node.warp_mode = mode;
    node.octaves = 2;
    return value_at(graph, graph.add(node), {1, 0, 0});
  };
  EXPECT_FLOAT_EQ(at(WarpMode::single), 1 + 3);
  // Amplitudes 2 and 1: 1 + 2 (1) + 1 (2 * 1); then with the second taken at 2 (1 + 2).
  EXPECT_FLOAT_EQ(at(WarpMode::independent), 5);
  EXPECT_FLOAT_EQ(at(WarpMode::progressive), 9);
}

TEST(Warp, IndependentOctavesAreThoseOfAnFbm) {
  Graph graph({.seed = 4});
  const NodeId source = graph.add(make(NodeType::perlin, {}, {0.3F}));
  const NodeId shift = graph.add(make(NodeType::simplex, {}, {0.2F}));
  Node fbm = make(NodeType::fbm, {shift}, {2, 0.5F, 0});
  fbm.octaves = 3;
  const NodeId by_fbm = graph.add(make(NodeType::warp, {source, graph.add(fbm)}, {2}));
  Node node = make(NodeType::warp, {source, shift}, {2, 2, 0.5F});
  node.warp_mode = WarpMode::independent;
  node.octaves = 3;
  const NodeId independent = graph.add(node);
  for (const Vec3 at : {Vec3{0.3, 1.2, 5.1}, Vec3{-7.3, 2.2, 0.4}}) {
    EXPECT_NEAR(value_at(graph, independent, at), value_at(graph, by_fbm, at), 1e-5F);
  }
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
