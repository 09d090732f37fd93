// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "graph/bounds.hpp"
#include "graph/compile.hpp"
#include "unit/graph/graph_support.hpp"

// Pictures over the ground: formulas by a second, plainer way, edges, and bits.

namespace mc::tests {
namespace {

std::shared_ptr<const Raster> random_picture(std::int32_t width, std::int32_t height) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> brightness(0, 1);
  auto raster = std::make_shared<Raster>();
  raster->width = width;
  raster->height = height;
  raster->samples.resize(static_cast<std::size_t>(width * height));
  for (float& v : raster->samples) v = brightness(random);
  return raster;
}

Node heightmap(std::shared_ptr<const Raster> raster, Wrap wrap, Filter filter) {
  Node node = make(NodeType::heightmap, {}, {-3, 2, 14, 10, 5});
  node.raster = std::move(raster);
  node.wrap = wrap;
  node.filter = filter;
  return node;
}

/// Pixel (i, j) of the endless picture.
double pixel(const Raster& raster, std::int64_t i, std::int64_t j, Wrap wrap) {
  const auto inside = [&](std::int64_t at, std::int64_t n) {
    if (wrap == Wrap::clamp) return std::clamp<std::int64_t>(at, 0, n - 1);
    const std::int64_t period = wrap == Wrap::repeat ? n : 2 * n;
    const std::int64_t m = ((at % period) + period) % period;
    return m < n ? m : 2 * n - 1 - m;
  };
  const std::int64_t at = inside(j, raster.height) * raster.width + inside(i, raster.width);
  return double{raster.samples[static_cast<std::size_t>(at)]};
}

double weight(Filter filter, double d) {
  d = std::abs(d);
  if (filter == Filter::linear) return std::max(0.0, 1 - d);
  // Keys' form of the spline, a = -1/2.
  if (d < 1) return ((1.5 * d - 2.5) * d) * d + 1;
  return d < 2 ? ((-0.5 * d + 2.5) * d - 4) * d + 2 : 0;
}

double expected(const Raster& raster, Wrap wrap, Filter filter, double x, double z) {
  const double u = (x + 3) * raster.width / 14 - 0.5;
  const double v = (z - 2) * raster.height / 10 - 0.5;
  if (filter == Filter::nearest) {
    return 5 * pixel(raster, std::llround(std::floor(u + 0.5)), std::llround(std::floor(v + 0.5)),
                     wrap);
  }
  double sum = 0;
  const auto i0 = static_cast<std::int64_t>(std::floor(u));
  const auto j0 = static_cast<std::int64_t>(std::floor(v));
  for (std::int64_t j = j0 - 1; j <= j0 + 2; ++j) {
    for (std::int64_t i = i0 - 1; i <= i0 + 2; ++i) {
      sum +=
          pixel(raster, i, j, wrap) * weight(filter, u - double(i)) * weight(filter, v - double(j));
    }
  }
  return 5 * sum;
}

class Heightmap : public testing::TestWithParam<std::tuple<Wrap, Filter>> {};

TEST_P(Heightmap, FollowsItsFormula) {
  const auto [wrap, filter] = GetParam();
  const auto raster = random_picture(7, 4);
  Graph graph({});
  const NodeId root = graph.add(heightmap(raster, wrap, filter));
  // Off the places where nearest jumps.
  const auto values = sampled(graph, root, {-40.03, 9, -30.07}, {0.31, 1, 0.29}, {300, 1, 240});
  for (std::size_t n = 0; n < values.size(); ++n) {
    const double x = -40.03 + double(n % 300) * 0.31;
    const double z = -30.07 + double(n / 300) * 0.29;
    ASSERT_NEAR(values[n], expected(*raster, wrap, filter, x, z), 2e-4) << x << " " << z;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Heightmap,
                         testing::Combine(testing::Values(Wrap::clamp, Wrap::repeat, Wrap::mirror),
                                          testing::Values(Filter::nearest, Filter::linear,
                                                          Filter::cubic)));

TEST(HeightmapEdges, PixelCentresGiveThePixels) {
  auto raster = std::make_shared<Raster>();
  raster->width = 2;
  raster->height = 2;
  raster->samples = {0.25F, 0.5F, 0.75F, 1.0F};
  for (const Filter filter : {Filter::nearest, Filter::linear, Filter::cubic}) {
    Graph graph({});
    Node node = make(NodeType::heightmap, {}, {0, 0, 2, 2, 8});
    node.raster = raster;
    node.filter = filter;
    const NodeId root = graph.add(node);
    EXPECT_EQ(sampled(graph, root, {0.5, 0, 0.5}, {1, 1, 1}, {2, 1, 2}),
              (std::vector<float>{2, 4, 6, 8}));
  }
}

TEST(HeightmapEdges, FarAndUnknownPlaces) {
  const auto raster = random_picture(7, 4);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const Wrap wrap : {Wrap::clamp, Wrap::repeat, Wrap::mirror}) {
    for (const float scale : {1e10F, -1e30F, kInfinity}) {
      Graph graph({});
      const NodeId x = graph.add(make(NodeType::x));
      const NodeId far = graph.add(make(NodeType::constant, {}, {1e38F}));
      const NodeId product = graph.add(make(NodeType::mul, {x, far}));
      const NodeId warped = graph.add(
          make(NodeType::warp, {graph.add(heightmap(raster, wrap, Filter::cubic)), product}, {1}));
      const float value =
          value_at(graph, warped, {double{scale} > 1e38 ? 1e30 : double{scale}, 0, 0});
      const bool finite = std::abs(scale) < 1.5F;
      EXPECT_TRUE(finite || std::isnan(value) || (value >= -2 && value <= 7)) << value;
    }
  }
}

TEST(HeightmapEdges, LiesOverTheDimsOfItsFractal) {
  const auto raster = random_picture(7, 4);
  Node node = heightmap(raster, Wrap::clamp, Filter::linear);
  node.dims = Dims::xy;
  Graph graph({});
  const NodeId root = graph.add(node);
  EXPECT_EQ(value_at(graph, root, {1, 5, 100}), value_at(graph, root, {1, 5, -7}));
  EXPECT_NE(value_at(graph, root, {1, 5, 0}), value_at(graph, root, {1, 7, 0}));
}

TEST(HeightmapEdges, GraphRefusesWhatIsNoPicture) {
  Graph graph({});
  EXPECT_THROW(graph.add(make(NodeType::heightmap, {}, {0, 0, 1, 1, 1})), Error);
  Node node = heightmap(random_picture(3, 3), Wrap::clamp, Filter::linear);
  node.numbers[2] = 0;
  EXPECT_THROW(graph.add(node), Error);
}

TEST(HeightmapEdges, PicturesAreToldApart) {
  Graph graph({});
  const auto one = random_picture(7, 4);
  auto other = std::make_shared<Raster>(*one);
  for (float& v : other->samples) v = 1 - v;
  const auto sum = [&](const Node& a, const Node& b) {
    const NodeId root = graph.add(make(NodeType::add, {graph.add(a), graph.add(b)}));
    return value_at(graph, root, {1, 0, 4});
  };
  const Node a = heightmap(one, Wrap::clamp, Filter::linear);
  EXPECT_NEAR(sum(a, heightmap(other, Wrap::clamp, Filter::linear)), 5, 1e-5);
  EXPECT_NE(sum(a, heightmap(one, Wrap::clamp, Filter::nearest)), sum(a, a));
}

TEST(HeightmapEdges, ConstantPlacesAreFolded) {
  Graph graph({});
  const auto raster = random_picture(7, 4);
  Node still = make(NodeType::affine, {graph.add(heightmap(raster, Wrap::clamp, Filter::cubic))});
  still.list = {0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 4};
  EXPECT_EQ(value_at(graph, graph.add(still), {9, 9, 9}),
            value_at(graph, still.inputs[0], {1, 0, 4}));
}

TEST(HeightmapEdges, BoundsHoldEverySample) {
  const auto raster = random_picture(7, 4);
  for (const Wrap wrap : {Wrap::clamp, Wrap::repeat, Wrap::mirror}) {
    for (const Filter filter : {Filter::nearest, Filter::linear, Filter::cubic}) {
      Graph made({});
      const graph::Program program =
          graph::compile(made, made.add(heightmap(raster, wrap, filter)));
      const graph::Interval everywhere{-100, 100};
      const graph::Instruction& code = program.code[program.result];
      const graph::Interval bounds =
          graph::bounds_of(code, {everywhere, everywhere, everywhere}, everywhere, everywhere, {});
      ASSERT_TRUE(bounds.known());
      EXPECT_LT(bounds.hi - bounds.lo, filter == Filter::cubic ? 8.1F : 5.1F);
      const NodeId root = made.add(heightmap(raster, wrap, filter));
      for (const float v : sampled(made, root, {-40, 0, -40}, {0.13, 1, 0.17}, {600, 1, 470})) {
        ASSERT_LE(bounds.lo, v);
        ASSERT_GE(bounds.hi, v);
      }
    }
  }
}

TEST(HeightmapEdges, BoundsVouchForNothingThatIsNotFinite) {
  auto raster = std::make_shared<Raster>(*random_picture(3, 3));
  raster->samples[4] = std::numeric_limits<float>::infinity();
  Graph made({});
  const graph::Program program =
      graph::compile(made, made.add(heightmap(raster, Wrap::clamp, Filter::linear)));
  EXPECT_FALSE(graph::bounds_of(program.code[program.result], {}, {0, 1}, {0, 1}, {}).known());
}

TEST(HeightmapEdges, BitsArePinned) {
  const auto raster = random_picture(7, 4);
  const std::array<std::uint64_t, 3> golden{5340276984353507078ULL, 11809778202032626647ULL,
                                            16141566671846438904ULL};
  for (const Filter filter : {Filter::nearest, Filter::linear, Filter::cubic}) {
    Graph graph({});
    const NodeId root = graph.add(heightmap(raster, Wrap::mirror, filter));
    EXPECT_EQ(hash_bits(sampled(graph, root, {-40.03, 9, -30.07}, {0.31, 1, 0.29}, {300, 1, 240})),
              golden[static_cast<std::size_t>(filter)]);
  }
}

TEST(Heightmap, IsSharedOnlyWithItsOwnKind) {
  Graph graph({});
  const auto picture = random_picture(7, 5);
  auto other = std::make_shared<Raster>(*picture);
  for (float& v : other->samples) v += 100;
  const auto added = [&](std::shared_ptr<const Raster> raster, Filter filter) {
    return graph.add(heightmap(std::move(raster), Wrap::clamp, filter));
  };
  const NodeId here = added(picture, Filter::linear);
  const NodeId higher = added(other, Filter::linear);
  const NodeId coarse = added(picture, Filter::nearest);
  const Vec3 at{0.3, 0, 4.1};
  const auto difference = [&](NodeId a, NodeId b) {
    return value_at(graph, graph.add(make(NodeType::sub, {a, b})), at);
  };
  EXPECT_NEAR(difference(higher, here), 500, 0.001);
  EXPECT_NE(difference(coarse, here), 0);
  EXPECT_EQ(difference(added(picture, Filter::linear), here), 0);
}

}  // namespace
}  // namespace mc::tests
