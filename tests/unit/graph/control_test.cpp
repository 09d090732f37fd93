// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "unit/graph/graph_support.hpp"

// The nodes that choose and reshape values: select, curve, terrace, floor_hard.

namespace mc::tests {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// What a node with one input makes of v.
float reshaped(const Node& node, float v) {
  Graph graph({});
  const NodeId zero = graph.add(make(NodeType::constant));
  NodeId source = graph.add(make(NodeType::constant, {}, {std::isfinite(v) ? v : 1}));
  if (std::isnan(v)) {
    source = graph.add(make(NodeType::div, {zero, zero}));
  } else if (std::isinf(v)) {
    const NodeId one = graph.add(make(NodeType::constant, {}, {v > 0 ? 1.0F : -1.0F}));
    source = graph.add(make(NodeType::div, {one, zero}));
  }
  Node with_source = node;
  with_source.inputs = {source};
  return value_at(graph, graph.add(with_source), {0, 0, 0});
}

float selected(float control, float threshold, float blend) {
  Graph graph({});
  const NodeId a = graph.add(make(NodeType::constant, {}, {10}));
  const NodeId b = graph.add(make(NodeType::constant, {}, {20}));
  const NodeId c = graph.add(make(NodeType::constant, {}, {control}));
  return value_at(graph, graph.add(make(NodeType::select, {a, b, c}, {threshold, blend})),
                  {0, 0, 0});
}

TEST(Select, TakesASideOfTheThreshold) {
  EXPECT_EQ(selected(1.9F, 2, 0), 10.0F);
  EXPECT_EQ(selected(2, 2, 0), 20.0F);
}

TEST(Select, BlendsAroundIt) {
  EXPECT_EQ(selected(0.9F, 2, 2), 10.0F);
  EXPECT_EQ(selected(2, 2, 2), 15.0F);
  EXPECT_EQ(selected(1.5F, 2, 2), 10 + 10 * 0.15625F);  // t = 1/4: t t (3 - 2 t)
  EXPECT_EQ(selected(3.1F, 2, 2), 20.0F);
}

TEST(Select, OfANanControlIsNan) {
  Graph graph({});
  const NodeId zero = graph.add(make(NodeType::constant));
  const NodeId nan = graph.add(make(NodeType::div, {zero, zero}));
  for (const float blend : {0.0F, 1.0F}) {
    const NodeId id = graph.add(make(NodeType::select, {zero, zero, nan}, {0, blend}));
    EXPECT_TRUE(std::isnan(value_at(graph, id, {0, 0, 0}))) << blend;
  }
}

Node curve(CurveShape shape, std::vector<float> points) {
  Node node = make(NodeType::curve);
  node.curve_shape = shape;
  node.list = std::move(points);
  return node;
}

TEST(Curve, PassesThroughItsPointsAndIsHeldBeyond) {
  for (const CurveShape shape : {CurveShape::linear, CurveShape::smooth, CurveShape::steps}) {
    const Node node = curve(shape, {-1, 5, 0, 1, 2, 9, 3, 9});
    EXPECT_EQ(reshaped(node, -7), 5.0F);
    EXPECT_EQ(reshaped(node, -1), 5.0F);
    EXPECT_FLOAT_EQ(reshaped(node, 0), 1.0F);
    EXPECT_FLOAT_EQ(reshaped(node, 2), 9.0F);
    EXPECT_EQ(reshaped(node, 3), 9.0F);
    EXPECT_EQ(reshaped(node, 1e30F), 9.0F);
    EXPECT_EQ(reshaped(node, kInfinity), 9.0F);
    EXPECT_EQ(reshaped(node, -kInfinity), 5.0F);
    EXPECT_TRUE(std::isnan(reshaped(node, std::nanf(""))));
  }
}

TEST(Curve, RunsBetweenItsPointsAsItsShapeSays) {
  const std::vector<float> points{0, 0, 4, 8};
  EXPECT_EQ(reshaped(curve(CurveShape::linear, points), 1), 2.0F);
  EXPECT_EQ(reshaped(curve(CurveShape::steps, points), 3.9F), 0.0F);
  EXPECT_EQ(reshaped(curve(CurveShape::smooth, points), 1), 8 * 0.15625F);  // level at both ends
  // Slopes 1, 3 over equal widths: their harmonic mean 3/2 at the middle; Hermite's cubic halfway.
  const Node smooth = curve(CurveShape::smooth, {0, 0, 1, 1, 2, 4});
  EXPECT_FLOAT_EQ(reshaped(smooth, 0.5F), 0.5F - 1.5F / 8);
  EXPECT_FLOAT_EQ(reshaped(smooth, 1.5F), 2.5F + 1.5F / 8);
}

TEST(Curve, SmoothOnesKeepTheOrderAndRangeOfTheirPoints) {
  const Node node = curve(CurveShape::smooth, {-2, -1, -1.5F, -0.9F, 0, 3, 0.1F, 7, 5, 7, 6, 2});
  float last = -1;
  for (float v = -2; v <= 0.1F; v += 0.003F) {
    const float now = reshaped(node, v);
    ASSERT_GE(now, last - 1e-6F) << v;
    last = now;
  }
  for (float v = 0.1F; v < 5; v += 0.05F) {
    ASSERT_NEAR(reshaped(node, v), 7.0F, 1e-5F) << v;
  }
}

TEST(Terrace, RisesOnlyOnItsRamps) {
  const Node node = make(NodeType::terrace, {}, {4, 1, 0.25F});  // 4 high from 1 on
  for (const float v : {1.0F, 2.5F, 4.0F}) {
    EXPECT_EQ(reshaped(node, v), 1.0F) << v;
  }
  EXPECT_EQ(reshaped(node, 4.5F), 3.0F);
  EXPECT_EQ(reshaped(node, 5), 5.0F);
  EXPECT_EQ(reshaped(node, -0.9F), -3.0F);
  EXPECT_EQ(reshaped(make(NodeType::terrace, {}, {4, 0, 0}), 3.999F), 0.0F);
  EXPECT_EQ(reshaped(make(NodeType::terrace, {}, {4, 0, 1}), 3), 3.0F);
  EXPECT_TRUE(std::isnan(reshaped(node, std::nanf(""))));
}

TEST(Terrace, TakesLevelsOfAnyHeight) {
  Node node = make(NodeType::terrace, {}, {0, 0, 0.5F});
  node.list = {0, 2, 10};
  EXPECT_EQ(reshaped(node, -3), 0.0F);
  EXPECT_EQ(reshaped(node, 0.9F), 0.0F);
  EXPECT_EQ(reshaped(node, 1.5F), 1.0F);
  EXPECT_EQ(reshaped(node, 5.9F), 2.0F);
  EXPECT_EQ(reshaped(node, 8), 6.0F);
  EXPECT_EQ(reshaped(node, 77), 10.0F);
  node.numbers[2] = 0;
  EXPECT_EQ(reshaped(node, 9.9F), 2.0F);
}

TEST(FloorHard, MakesSolidBelowItsHeight) {
  for (const Convention convention : {Convention::density, Convention::sdf}) {
    const float sign = convention == Convention::density ? 1.0F : -1.0F;
    Graph graph({.convention = convention});
    const NodeId air = graph.add(make(NodeType::constant, {}, {-2 * sign}));
    const NodeId floor = graph.add(make(NodeType::floor_hard, {air}, {7, 5}));
    EXPECT_EQ(value_at(graph, floor, {0, 6.9, 0}), 3 * sign);
    EXPECT_EQ(value_at(graph, floor, {0, 7, 0}), -2 * sign);
  }
}

TEST(Lists, OfTheWrongSizeOrOrderAreRefused) {
  Graph graph({});
  const NodeId x = graph.add(make(NodeType::x));
  const auto refused = [&](NodeType type, std::vector<NodeId> inputs, std::vector<float> list) {
    Node node = make(type, std::move(inputs), {1});
    node.list = std::move(list);
    EXPECT_THROW(graph.add(node), Error);
  };
  refused(NodeType::affine, {x}, {1, 2, 3});
  refused(NodeType::curve, {x}, {});
  refused(NodeType::curve, {x}, {0, 1});
  refused(NodeType::curve, {x}, {0, 1, 2});
  refused(NodeType::curve, {x}, {0, 1, 0, 1});
  refused(NodeType::curve, {x}, {0, 1, 2, kInfinity});
  refused(NodeType::terrace, {x}, {1});
  refused(NodeType::terrace, {x}, {1, 1});
  refused(NodeType::capsule, {}, {0, 0, 0, 1, 1, 1, 1});
  refused(NodeType::roundbox, {}, {});
  refused(NodeType::sphere, {}, {1});
}

}  // namespace
}  // namespace mc::tests
