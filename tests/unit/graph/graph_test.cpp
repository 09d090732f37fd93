// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/simd_target.hpp"
#include "graph/float_math.hpp"
#include "unit/graph/graph_support.hpp"

// Arithmetic, solids and combinations, the limits of a graph, and the bits of every formula.

namespace mc::tests {
namespace {

TEST(FloatMath, FloorIsIeeeFloor) {
  for (const float v : {0.0F, -0.0F, 0.3F, -0.3F, -1.0F, 8388607.5F, -8388607.5F, 1e20F, -1e20F,
                        std::numeric_limits<float>::infinity()}) {
    EXPECT_EQ(std::bit_cast<std::uint32_t>(graph::exact_floor(v)),
              std::bit_cast<std::uint32_t>(std::floor(v)))
        << v;
  }
  EXPECT_TRUE(std::isnan(graph::exact_floor(std::nanf(""))));
}

TEST(FloatMath, SineIsWithinItsError) {
  double worst = 0;
  for (float v = -8192; v <= 8192; v += 0.0371F) {
    worst = std::max(worst, std::abs(double{graph::exact_sin(v)} - std::sin(double{v})));
  }
  EXPECT_LT(worst, 2e-7);
  EXPECT_EQ(graph::exact_sin(1e30F), 0.0F);
  EXPECT_TRUE(std::isnan(graph::exact_sin(std::numeric_limits<float>::infinity())));
}

TEST(FloatMath, PowerIsWithinItsError) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> exponent(-20, 20);
  for (int n = 0; n < 200000; ++n) {
    const float a = std::exp2(exponent(random) * 0.5F);
    const float b = exponent(random) * 0.5F;
    const double right = std::pow(double{a}, double{b});
    const double allowed = 2e-7 * (1 + std::abs(b * std::log2(double{a})));
    ASSERT_LE(std::abs(graph::exact_pow(a, b) - right), allowed * right) << a << " ^ " << b;
  }
}

TEST(FloatMath, PowerKnowsItsSpecialCases) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(graph::exact_pow(5, 0), 1.0F);
  EXPECT_EQ(graph::exact_pow(0, 2), 0.0F);
  EXPECT_EQ(graph::exact_pow(0, -1), kInfinity);
  EXPECT_EQ(graph::exact_pow(1, 1e30F), 1.0F);
  EXPECT_EQ(graph::exact_pow(2, 1000), kInfinity);
  EXPECT_EQ(graph::exact_pow(2, -1000), 0.0F);
  EXPECT_EQ(graph::exact_pow(2, 10), 1024.0F);
  EXPECT_FLOAT_EQ(graph::exact_pow(-3, 3), -27.0F);
  EXPECT_FLOAT_EQ(graph::exact_pow(-3, 2), 9.0F);
  EXPECT_TRUE(std::isnan(graph::exact_pow(-3, 0.5F)));
  EXPECT_TRUE(std::isnan(graph::exact_pow(std::nanf(""), 0)));
}

class Arithmetic : public testing::Test {
 protected:
  NodeId number(float v) { return graph_.add(make(NodeType::constant, {}, {v})); }
  float of(NodeType type, std::initializer_list<float> inputs, std::array<float, 6> p = {}) {
    std::vector<NodeId> ids;
    for (const float v : inputs) {
      ids.push_back(number(v));
    }
    return value_at(graph_, graph_.add(make(type, ids, p)), {0, 0, 0});
  }
  Graph graph_{GraphSettings{}};
};

TEST_F(Arithmetic, EveryNodeDoesWhatItSays) {
  EXPECT_EQ(of(NodeType::add, {1, 2, 4}), 7.0F);
  EXPECT_EQ(of(NodeType::mul, {2, 3, 4}), 24.0F);
  EXPECT_EQ(of(NodeType::min, {3, 1, 2}), 1.0F);
  EXPECT_EQ(of(NodeType::max, {3, 1, 5}), 5.0F);
  EXPECT_EQ(of(NodeType::sub, {3, 1}), 2.0F);
  EXPECT_EQ(of(NodeType::div, {3, 2}), 1.5F);
  EXPECT_EQ(of(NodeType::mod, {-1, 3}), 2.0F);
  EXPECT_EQ(of(NodeType::pow, {2, 3}), 8.0F);
  EXPECT_EQ(of(NodeType::abs, {-2}), 2.0F);
  EXPECT_EQ(of(NodeType::neg, {2}), -2.0F);
  EXPECT_EQ(of(NodeType::sqrt, {9}), 3.0F);
  EXPECT_EQ(of(NodeType::floor, {-1.5F}), -2.0F);
  EXPECT_EQ(of(NodeType::fract, {-1.25F}), 0.75F);
  EXPECT_EQ(of(NodeType::sin, {0}), 0.0F);
  EXPECT_EQ(of(NodeType::clamp, {7}, {0, 5}), 5.0F);
  EXPECT_EQ(of(NodeType::remap, {1}, {0, 2, 10, 20}), 15.0F);
  EXPECT_EQ(of(NodeType::smoothstep, {1}, {0, 2}), 0.5F);
  EXPECT_EQ(of(NodeType::mix, {10, 20, 0.25F}), 12.5F);
}

TEST(Solids, AreSignedDistances) {
  Graph graph({.iso = 5});
  const NodeId ball = graph.add(make(NodeType::sphere, {}, {1, 2, 3, 2}));
  EXPECT_EQ(value_at(graph, ball, {1, 2, 3}), 7.0F);
  EXPECT_EQ(value_at(graph, ball, {1, 5, 3}), 4.0F);
  const NodeId box = graph.add(make(NodeType::box, {}, {0, 0, 0, 2, 4, 6}));
  EXPECT_EQ(value_at(graph, box, {0, 0, 0}), 6.0F);
  EXPECT_EQ(value_at(graph, box, {4, 6, 0}), 0.0F);  // 5 away from the edge (1, 2)
  const NodeId plane = graph.add(make(NodeType::plane, {}, {0, 1, 0, 2}));
  EXPECT_EQ(value_at(graph, plane, {9, 0, 9}), 7.0F);
  Node torus = make(NodeType::torus, {}, {0, 0, 10, 4, 1});
  torus.axis = 2;
  EXPECT_EQ(value_at(graph, graph.add(torus), {0, 4, 10}), 6.0F);
  EXPECT_EQ(value_at(graph, graph.add(torus), {0, 4, 13}), 3.0F);
}

TEST(Combinations, FollowTheConventionAndItsIso) {
  for (const Convention convention : {Convention::density, Convention::sdf}) {
    const float sign = convention == Convention::density ? 1.0F : -1.0F;
    Graph graph({.convention = convention, .iso = 10});
    const NodeId in = graph.add(make(NodeType::constant, {}, {10 + sign * 3}));
    const NodeId out = graph.add(make(NodeType::constant, {}, {10 - sign * 2}));
    const auto combined = [&](NodeType type, std::vector<NodeId> inputs) {
      return value_at(graph, graph.add(make(type, std::move(inputs))), {0, 0, 0});
    };
    EXPECT_EQ(combined(NodeType::unite, {in, out}), 10 + sign * 3);
    EXPECT_EQ(combined(NodeType::intersect, {in, out}), 10 - sign * 2);
    EXPECT_EQ(combined(NodeType::difference, {in, out}), 10 + sign * 2);
    EXPECT_EQ(combined(NodeType::difference, {in, in}), 10 - sign * 3);
    EXPECT_EQ(combined(NodeType::complement, {in}), 10 - sign * 3);
    EXPECT_EQ(combined(NodeType::min, {in, out}), std::min(10 + sign * 3, 10 - sign * 2));
  }
}

TEST(Combinations, SmoothOnesAddTheFillet) {
  Graph graph({});
  const NodeId one = graph.add(make(NodeType::constant, {}, {1}));
  const NodeId two = graph.add(make(NodeType::constant, {}, {2}));
  const auto combined = [&](NodeType type, NodeId a, NodeId b, float k) {
    return value_at(graph, graph.add(make(type, {a, b}, {k})), {0, 0, 0});
  };
  // k = 4, |a - b| = 1: h = 3/4, h h k / 4 = 9/16.
  EXPECT_EQ(combined(NodeType::unite, one, two, 4), 2 + 9.0F / 16);
  EXPECT_EQ(combined(NodeType::intersect, one, two, 4), 1 - 9.0F / 16);
  EXPECT_EQ(combined(NodeType::unite, one, two, 0.5F), 2.0F);
}

TEST(Graph, RefusesWhatItCannotHold) {
  Graph graph({});
  EXPECT_THROW(graph.add(make(NodeType::neg, {NodeId{5}})), Error);
  EXPECT_THROW(graph.add(make(NodeType::sub)), Error);
  EXPECT_THROW(graph.add(make(NodeType::constant, {}, {INFINITY})), Error);
  NodeId deep = graph.add(make(NodeType::x));
  for (std::uint32_t n = 1; n < Graph::kMaxDepth; ++n) {
    deep = graph.add(make(NodeType::neg, {deep}));
  }
  try {
    graph.add(make(NodeType::neg, {deep}));
    FAIL() << "a path that is too long was taken";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "nodes nest deeper than 256 levels");
  }
  EXPECT_EQ(value_at(graph, deep, {3, 0, 0}), -3.0F);
}

TEST(Graph, RefusesToExpandWithoutBound) {
  Graph graph({});
  NodeId id = graph.add(make(NodeType::perlin, {}, {1}));
  for (int n = 0; n < 4; ++n) {
    Node fbm = make(NodeType::fbm, {id}, {2, 0.5F, 0});
    fbm.octaves = 32;
    id = graph.add(fbm);
  }
  try {
    (void)graph.compile(id);
    FAIL() << "32^4 octaves were compiled";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "fractals and warps expand to more than 16384 operations a sample; nest fewer of "
                 "them, or lower the octaves");
  }
}

TEST(Graph, ValuesDoNotDependOnHowTheLatticeIsCut) {
  Graph graph({.seed = 3});
  const NodeId noise = graph.add(make(NodeType::simplex, {}, {0.1F}));
  const NodeId y = graph.add(make(NodeType::y));
  const NodeId root = graph.add(make(NodeType::add, {noise, y, noise}));
  const auto whole = sampled(graph, root, {-7, 2, 1}, {0.5, 0.25, 1}, {300, 3, 2});
  float one = 0;
  graph.compile(root).sample({-7, 2, 1}, {0.5, 0.25, 1}, {271, 2, 1},
                             View3<float>(&one, {1, 1, 1}));
  EXPECT_EQ(one, whole[(1 * 3 + 2) * 300 + 271]);
}

struct Golden {
  const char* name;
  NodeType type;
  std::array<float, 6> numbers;
  std::uint64_t hash;
  std::vector<float> list{};
};

/// Whether the golden bits are of this node over noise; else its inputs are the coordinates.
bool is_over_noise(NodeType type) {
  return type >= NodeType::fbm && type <= NodeType::repeat;  // fractals, warps, transforms
}

// The formulas are final: whoever makes them faster must leave these alone, on every SIMD target.
// Inputs are the coordinates; the lattice has negative, zero and large places.
std::vector<float> golden_values(const Golden& golden) {
  Graph graph({.seed = 1337, .iso = 0.25F});
  std::vector<NodeId> inputs;
  const NodeType axes[] = {NodeType::x, NodeType::y, NodeType::z};
  const int n_inputs = golden.name[0] - '0';
  for (int n = 0; n < n_inputs; ++n) {
    inputs.push_back(graph.add(make(axes[n])));
  }
  Node node = make(golden.type, inputs, golden.numbers);
  node.seed = 7;
  node.octaves = 4;
  node.list = golden.list;
  const auto says = [&](std::string_view word) {
    return std::string_view(golden.name).ends_with(word);
  };
  if (says(" xz")) node.dims = Dims::xz;
  if (says(" smooth")) node.curve_shape = CurveShape::smooth;
  if (says(" value")) node.cell_return = CellReturn::value;
  if (says(" f2")) node.cell_return = CellReturn::f2;
  if (says(" f2-f1")) node.cell_return = CellReturn::f2_f1;
  if (says(" manhattan")) node.cell_metric = CellMetric::manhattan;
  if (says(" chebyshev")) node.cell_metric = CellMetric::chebyshev;
  if (says(" progressive")) node.warp_mode = WarpMode::progressive;
  if (says(" independent")) node.warp_mode = WarpMode::independent;
  if (is_over_noise(golden.type)) {
    node.inputs[0] = graph.add(make(NodeType::perlin, {}, {0.7F}));
    if (node.warp_mode != WarpMode::single) node.inputs[1] = node.inputs[0];
  }
  return sampled(graph, graph.add(node), {-9.25, -3.5, -4}, {0.37, 1.125, 0.83}, {67, 9, 11});
}

TEST(Graph, FormulasKeepTheirBitsOnEverySimdTarget) {
  const Golden golden[] = {
#include "unit/graph/golden_bits.inc"
  };
  for (const std::string& target : base::simd_targets()) {
    ASSERT_TRUE(base::set_simd_target(target));
    for (const Golden& g : golden) {
      const std::uint64_t hash = hash_bits(golden_values(g));
      EXPECT_EQ(hash, g.hash) << target << " " << g.name << " 0x" << std::hex << hash;
    }
  }
  base::reset_simd_target();
}

}  // namespace
}  // namespace mc::tests
