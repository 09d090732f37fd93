// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "unit/graph/graph_support.hpp"

// Transforms: where the source is looked up, and what stays as it is.

namespace mc::tests {
namespace {

/// The coordinates at which a transform looks its source up for the point p.
Vec3 looked_up(Node transform, const Vec3& p) {
  Vec3 out{};
  const NodeType axes[] = {NodeType::x, NodeType::y, NodeType::z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Graph graph({});
    transform.inputs = {graph.add(make(axes[axis]))};
    out[axis] = value_at(graph, graph.add(transform), p);
  }
  return out;
}

Node affine(std::vector<float> matrix, float factor = 0) {
  Node node = make(NodeType::affine, {}, {factor});
  node.list = std::move(matrix);
  return node;
}

TEST(Affine, IsTheMatrixTimesThePoint) {
  const Node node = affine({2, 0, -1, 3, 0, 1, 0, 0, 0.5F, 0.25F, 4, -7});
  EXPECT_EQ(looked_up(node, {1, 2, 3}), (Vec3{2 - 3 + 3, 2, 0.5 + 0.5 + 12 - 7}));
}

TEST(Affine, LeavesOutWhatHasFactorZero) {
  // A y that is NaN or infinite does not reach a row without it; an empty row is its number.
  Graph graph({});
  Node node = affine({1, 0, 0, 0, 0, 0, 0, 6, 0, 0, 1, 0});
  const NodeId zero = graph.add(make(NodeType::constant));
  const NodeId nan = graph.add(make(NodeType::div, {zero, zero}));
  const NodeId x = graph.add(make(NodeType::x));
  const NodeId y = graph.add(make(NodeType::y));
  node.inputs = {graph.add(make(NodeType::add, {x, y}))};
  EXPECT_EQ(value_at(graph, graph.add(node), {3, 1e30, 5}), 9.0F);
  node.inputs = {nan};
  EXPECT_TRUE(std::isnan(value_at(graph, graph.add(node), {3, 4, 5})));
}

TEST(Affine, FactorScalesWhatLiesAboveOrBelowIso) {
  Graph graph({.iso = 10});
  Node node = affine({0.5F, 0, 0, 0, 0, 0.5F, 0, 0, 0, 0, 0.5F, 0}, 2);
  node.inputs = {graph.add(make(NodeType::sphere, {}, {0, 0, 0, 3}))};
  EXPECT_EQ(value_at(graph, graph.add(node), {4, 0, 0}), 12.0F);  // a ball of radius 6
  EXPECT_EQ(value_at(graph, graph.add(node), {0, 8, 0}), 8.0F);
}

TEST(Mirror, FoldsSpaceAtItsPlane) {
  Node node = make(NodeType::mirror, {}, {3, 1});
  node.axis = 0;
  EXPECT_EQ(looked_up(node, {5, 1, 2}), (Vec3{5, 1, 2}));
  EXPECT_EQ(looked_up(node, {1, 1, 2}), (Vec3{5, 1, 2}));
  node.numbers = {3, -1};
  node.axis = 2;
  EXPECT_EQ(looked_up(node, {5, 1, 7}), (Vec3{5, 1, -1}));
  EXPECT_EQ(looked_up(node, {5, 1, 2}), (Vec3{5, 1, 2}));
}

TEST(Repeat, LooksUpTheNearestCopy) {
  const Node endless = make(NodeType::repeat, {}, {4, 0, 10, 0, 0, 0});
  EXPECT_EQ(looked_up(endless, {9, 9, 9}), (Vec3{1, 9, -1}));
  EXPECT_EQ(looked_up(endless, {-3, 9, 4}), (Vec3{1, 9, 4}));
  EXPECT_EQ(looked_up(endless, {2, 0, -5}), (Vec3{-2, 0, -5 + 10 * 0}))
      << "half a period rounds up";
  const Node three = make(NodeType::repeat, {}, {4, 4, 4, 3, 1, 0});
  EXPECT_EQ(looked_up(three, {9, 9, 9}), (Vec3{1, 9, 1}));
  EXPECT_EQ(looked_up(three, {21, 0, 0}), (Vec3{13, 0, 0}));
  EXPECT_EQ(looked_up(three, {-6, 0, 0}), (Vec3{-6, 0, 0}));
}

TEST(Transforms, KeepSeedsOfNoiseBelow) {
  Graph graph({.seed = 4});
  Node noise = make(NodeType::perlin, {}, {0.5F});
  noise.seed = 9;
  const NodeId id = graph.add(noise);
  Node moved = affine({1, 0, 0, -2, 0, 1, 0, 0, 0, 0, 1, 1});
  moved.inputs = {id};
  EXPECT_EQ(value_at(graph, graph.add(moved), {3, 1, 1}), value_at(graph, id, {1, 1, 2}));
}

TEST(Transforms, OfXAndZStayOutOfTheRowsThatDependOnY) {
  // What a plane shares must be the same for all rows: a rotation about y must not mix y in.
  Graph graph({});
  Node turned = affine({0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0});
  Node flat = make(NodeType::perlin, {}, {0.3F});
  flat.dims = Dims::xz;
  turned.inputs = {graph.add(flat)};
  const auto rows = sampled(graph, graph.add(turned), {0.2, -1, 0.4}, {0.7, 1, 0.7}, {9, 3, 1});
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(rows[i], rows[9 + i]);
    EXPECT_EQ(rows[i], rows[18 + i]);
  }
}

}  // namespace
}  // namespace mc::tests
