// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "graph/bounds.hpp"
#include "graph/compile.hpp"
#include "unit/graph/graph_support.hpp"

// Volumes in the world: values worked out by hand and by a second, plainer way, places, what lies
// beyond them, bounds and bits.

namespace mc::tests {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

using Samples = std::shared_ptr<const SampledVolume>;

std::shared_ptr<SampledVolume> volume_of(const Index3& dims, const std::vector<float>& samples,
                                         const Affine& to_index = {}) {
  auto volume = std::make_shared<SampledVolume>();
  volume->dims = dims;
  volume->to_index = to_index;
  volume->samples.assign(samples.begin(), samples.end());
  return volume;
}

std::shared_ptr<SampledVolume> random_volume(const Index3& dims, const Affine& to_index = {}) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> value(-2, 3);
  std::vector<float> samples(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]));
  for (float& v : samples) v = value(random);
  return volume_of(dims, samples, to_index);
}

Node reading(Samples volume, Filter filter = Filter::linear, std::optional<float> outside = {}) {
  Node node = make(NodeType::volume);
  node.volume = std::move(volume);
  node.filter = filter;
  node.outside = outside;
  return node;
}

float read_at(const Node& node, const Vec3& p) {
  Graph graph({});
  return value_at(graph, graph.add(node), p);
}

/// i + 2 j + 4 k at the corners of one cell.
const std::vector<float> kRamp{0, 1, 2, 3, 4, 5, 6, 7};

/// A turn by 30 degrees about z, another scale along z, and a shift.
const Affine kTurned{{0.866, 0.5, 0, 1.5, -0.5, 0.866, 0, 2.25, 0, 0, 0.7, 0.5}};

TEST(VolumeNode, IsTrilinearBetweenSamples) {
  const Node ramp = reading(volume_of({2, 2, 2}, kRamp));
  EXPECT_EQ(read_at(ramp, {0.25, 0.5, 0.75}), 4.25F);
  EXPECT_EQ(read_at(ramp, {1, 0, 0.5}), 3.0F);
  const Node corner = reading(volume_of({2, 2, 2}, {0, 0, 0, 0, 0, 0, 0, 8}));
  EXPECT_EQ(read_at(corner, {0.5, 0.5, 0.5}), 1.0F);
  EXPECT_EQ(read_at(corner, {0.25, 0.5, 0.75}), 0.75F);
  const Node row = reading(volume_of({4, 1, 1}, {1, 3, 7, 15}));
  EXPECT_EQ(read_at(row, {2.5, 0, 0}), 11.0F);
}

TEST(VolumeNode, LiesWhereItsMapSays) {
  // i = y, j = 1 - x, k = 2 z: turned about z, and another spacing.
  const Affine turned{{0, 1, 0, 0, -1, 0, 0, 1, 0, 0, 2, 0}};
  EXPECT_EQ(read_at(reading(volume_of({2, 2, 2}, kRamp, turned)), {0.25, 0.5, 0.125}), 3.0F);
  // i = 1 - x: mirrored.
  const Affine mirrored{{-1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0}};
  EXPECT_EQ(read_at(reading(volume_of({2, 2, 2}, kRamp, mirrored)), {0.25, 0.5, 0.5}), 3.75F);
}

TEST(VolumeNode, NearestGivesSamplesOnly) {
  const Node ramp = reading(volume_of({2, 2, 2}, kRamp), Filter::nearest);
  EXPECT_EQ(read_at(ramp, {0.49, 0, 0}), 0.0F);
  EXPECT_EQ(read_at(ramp, {0.5, 0.51, 0.2}), 3.0F);
  EXPECT_EQ(read_at(ramp, {7, 7, 7}), 7.0F);
}

TEST(VolumeNode, GoesOnBeyondItsSamples) {
  const auto plain = volume_of({2, 2, 2}, std::vector<float>(8, 4));
  const auto padded = std::make_shared<SampledVolume>(*plain);
  padded->background = 2;
  struct Case {
    Node node;
    float half;    // half a step before the first sample
    float beyond;  // a step and more
  };
  const Case cases[]{{reading(plain), 4, 4},
                     {reading(padded), 3, 2},
                     {reading(plain, Filter::linear, 10.0F), 7, 10},
                     {reading(padded, Filter::linear, 10.0F), 7, 10},
                     {reading(padded, Filter::nearest, 10.0F), 4, 10}};
  for (const Case& c : cases) {
    EXPECT_EQ(read_at(c.node, {-0.5, 0, 0}), c.half);
    EXPECT_EQ(read_at(c.node, {0, 1, c.node.filter == Filter::nearest ? 1.49 : 1.5}), c.half);
    for (const double far : {-1.0, 2.0, -1e30, 3e38}) {
      EXPECT_EQ(read_at(c.node, {0, far, 1}), c.beyond) << far;
    }
  }
}

TEST(VolumeNode, GivesItsSamplesBackBitByBit) {
  const Vec3 spacing{0.1, 0.7, 1.0 / 3};
  for (const Vec3& origin : {Vec3{-0.3, 100.1, -2}, Vec3{0, 0, 0}, Vec3{12345.678, -0.7, 1e-7}}) {
    const Affine to_index{{1 / spacing[0], 0, 0, -origin[0] / spacing[0], 0, 1 / spacing[1], 0,
                           -origin[1] / spacing[1], 0, 0, 1 / spacing[2], -origin[2] / spacing[2]}};
    const auto volume = random_volume({40, 5, 6}, to_index);
    volume->samples[17] = kNan;
    volume->samples[90] = kInfinity;
    volume->samples[91] = -0.0F;
    Graph graph({});
    const NodeId root = graph.add(reading(volume));
    const std::vector<float> values = sampled(graph, root, origin, spacing, {40, 5, 6});
    EXPECT_EQ(std::memcmp(values.data(), volume->samples.data(), values.size() * 4), 0);
  }
}

/// Weights of all eight samples, in double.
double expected(const SampledVolume& volume, float outside, const Vec3& p) {
  const Vec3 at = volume.to_index(p);
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::size_t place = 0;
    bool inside = true;
    for (std::size_t axis = 3; axis-- > 0;) {
      const bool upper = (corner >> axis & 1) != 0;
      const double lower = std::floor(at[axis]);
      weight *= upper ? at[axis] - lower : 1 - (at[axis] - lower);
      const auto index = static_cast<std::int64_t>(lower) + (upper ? 1 : 0);
      inside = inside && index >= 0 && index < volume.dims[axis];
      place = place * static_cast<std::size_t>(volume.dims[axis]) +
              static_cast<std::size_t>(std::max<std::int64_t>(index, 0));
    }
    sum += weight * double{inside ? volume.samples[place] : outside};
  }
  return sum;
}

TEST(VolumeNode, FollowsItsFormula) {
  const auto volume = random_volume({7, 5, 6}, kTurned);
  Graph graph({});
  const NodeId root = graph.add(reading(volume, Filter::linear, -3.0F));
  const Vec3 origin{-8.01, -7.03, -4.07};
  const Vec3 step{0.53, 0.47, 0.59};
  const auto values = sampled(graph, root, origin, step, {30, 30, 25});
  std::size_t n_inside = 0;
  for (std::size_t n = 0; n < values.size(); ++n) {
    const Vec3 p{origin[0] + double(n % 30) * step[0], origin[1] + double(n / 30 % 30) * step[1],
                 origin[2] + double(n / 900) * step[2]};
    ASSERT_NEAR(values[n], expected(*volume, -3.0F, p), 5e-5) << p[0] << " " << p[1] << " " << p[2];
    n_inside += values[n] != -3.0F ? 1 : 0;
  }
  EXPECT_GT(n_inside, 500U);
}

TEST(VolumeNode, UnknownPlacesAreUnknown) {
  Graph graph({});
  const NodeId root = graph.add(reading(volume_of({2, 2, 2}, kRamp)));
  for (const float shift : {kInfinity, -kInfinity, kNan}) {
    const NodeId big = graph.add(make(NodeType::constant, {}, {3e38F}));
    const NodeId twice = graph.add(make(NodeType::add, {big, big}));  // infinite
    const NodeId sign = graph.add(make(NodeType::constant, {}, {shift < 0 ? -1.0F : 1.0F}));
    const NodeId minus = graph.add(make(NodeType::sub, {twice, twice}));
    const NodeId moved = std::isnan(shift) ? minus : graph.add(make(NodeType::mul, {twice, sign}));
    const NodeId warped = graph.add(make(NodeType::warp, {root, moved}, {1}));
    EXPECT_TRUE(std::isnan(value_at(graph, warped, {0, 0, 0}))) << shift;
  }
}

TEST(VolumeNode, IsSharedOnlyWithItsOwnKind) {
  Graph graph({});
  const auto volume = random_volume({4, 4, 4});
  auto other = std::make_shared<SampledVolume>(*volume);
  for (float& v : other->samples) v += 100;
  const auto difference = [&](const Node& a, const Node& b, const Vec3& at) {
    return value_at(graph, graph.add(make(NodeType::sub, {graph.add(a), graph.add(b)})), at);
  };
  const Node here = reading(volume);
  EXPECT_NEAR(difference(reading(other), here, {1.3, 1.3, 1.3}), 100, 1e-4);
  EXPECT_NE(difference(reading(volume, Filter::nearest), here, {1.3, 1.3, 1.3}), 0);
  EXPECT_NE(difference(reading(volume, Filter::linear, 50.0F), here, {-9, 0, 0}), 0);
  EXPECT_EQ(difference(reading(volume), here, {1.3, 1.3, 1.3}), 0);
}

TEST(VolumeNode, GraphRefusesWhatIsNoVolume) {
  Graph graph({});
  const auto refused = [&](const Node& node) { EXPECT_THROW(graph.add(node), Error); };
  refused(make(NodeType::volume));
  const auto volume = random_volume({3, 3, 3});
  refused(reading(volume, Filter::cubic));
  refused(reading(volume, Filter::linear, kInfinity));
  auto wrong = std::make_shared<SampledVolume>(*volume);
  wrong->dims = {3, 3, 4};
  refused(reading(wrong));
  wrong->dims = {-3, -3, 3};
  refused(reading(wrong));
  wrong->dims = {3, 3, 3};
  wrong->to_index.m[5] = std::numeric_limits<double>::quiet_NaN();
  refused(reading(wrong));
  wrong->to_index.m[5] = 1e101;
  refused(reading(wrong));
  EXPECT_EQ(graph.size(), 0U);
}

graph::Interval bounds_over(const Node& node, const graph::Interval (&at)[3]) {
  Graph made({});
  const graph::Program program = graph::compile(made, made.add(node));
  return graph::bounds_of(program.code[program.result], {at[0], at[1], at[2]}, at[0], at[1], at[2]);
}

TEST(VolumeNode, BoundsHoldEverySample) {
  const auto volume = random_volume({9, 8, 7}, kTurned);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> corner(-12, 10);
  std::uniform_real_distribution<float> size(0, 3);
  int n_close = 0;
  for (int n = 0; n < 300; ++n) {
    graph::Interval at[3];
    Vec3 origin{};
    Vec3 step{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      at[axis].lo = corner(random);
      at[axis].hi = at[axis].lo + size(random);
      origin[axis] = at[axis].lo;
      step[axis] = (double{at[axis].hi} - at[axis].lo) / 9;
    }
    const Node node = reading(volume, n % 2 == 0 ? Filter::linear : Filter::nearest,
                              n % 3 == 0 ? std::optional<float>() : 0.5F);
    const graph::Interval bounds = bounds_over(node, at);
    ASSERT_TRUE(bounds.known());
    n_close += bounds.hi - bounds.lo < 4 ? 1 : 0;
    Graph made({});
    const NodeId root = made.add(node);
    for (const float v : sampled(made, root, origin, step, {9, 9, 9})) {
      ASSERT_LE(bounds.lo, v) << n;
      ASSERT_GE(bounds.hi, v) << n;
    }
  }
  EXPECT_GT(n_close, 50);
}

TEST(VolumeNode, BoundsOfManySamplesAreThoseOfAll) {
  const graph::Interval wide[3]{{-1e6F, 1e6F}, {-1e6F, 1e6F}, {-1e6F, 1e6F}};
  const auto volume = random_volume({30, 30, 30});
  const graph::Interval bounds = bounds_over(reading(volume, Filter::nearest, 7.0F), wide);
  EXPECT_EQ(bounds.lo, *std::min_element(volume->samples.begin(), volume->samples.end()));
  EXPECT_EQ(bounds.hi, 7.0F);
}

TEST(VolumeNode, BoundsVouchForNothingThatIsNotFinite) {
  const auto volume = random_volume({30, 30, 30});
  volume->samples[0] = kNan;
  const graph::Interval near_it[3]{{0, 0.5F}, {0, 0.5F}, {0, 0.5F}};
  const graph::Interval far[3]{{9, 9.5F}, {9, 9.5F}, {9, 9.5F}};
  const graph::Interval wide[3]{{0, 30}, {0, 30}, {0, 30}};
  EXPECT_FALSE(bounds_over(reading(volume), near_it).known());
  EXPECT_TRUE(bounds_over(reading(volume), far).known());
  EXPECT_FALSE(bounds_over(reading(volume), wide).known());
}

TEST(VolumeNode, BitsArePinned) {
  const auto volume = random_volume({9, 8, 7}, kTurned);
  const auto hash = [&](Filter filter, std::optional<float> outside) {
    Graph graph({});
    const NodeId root = graph.add(reading(volume, filter, outside));
    return hash_bits(sampled(graph, root, {-9.03, -7.01, -3.07}, {0.31, 0.33, 0.29}, {60, 50, 55}));
  };
  EXPECT_EQ(hash(Filter::linear, 0.5F), 12733622884856342157ULL);
  EXPECT_EQ(hash(Filter::linear, std::nullopt), 1113899928091446818ULL);
  EXPECT_EQ(hash(Filter::nearest, std::nullopt), 18220226823346422037ULL);
}

}  // namespace
}  // namespace mc::tests
