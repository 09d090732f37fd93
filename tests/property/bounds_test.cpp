// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "graph/bounds.hpp"
#include "graph/compile.hpp"
#include "graph/machine.hpp"
#include "graph/noise_range.hpp"
#include "graph/rows.hpp"
#include "support/random_graphs.hpp"

// Interval bounds hold every sample, of every value that a program makes on its way.

namespace mc::test {
namespace {

using graph::Interval;
using graph::WorldBox;

std::vector<Interval> all_bounds(const graph::Program& program, const WorldBox& box) {
  std::vector<Interval> out;
  for (const graph::Instruction& i : program.code) {
    const auto at = [&](std::size_t n) { return n < i.n_in ? out[i.in[n]] : Interval{}; };
    out.push_back(graph::bounds_of(i, box, at(0), at(1), at(2)));
  }
  return out;
}

/// A block somewhere, mostly small against the features of the graph.
struct Block {
  Vec3 lo;
  Vec3 size;

  explicit Block(std::mt19937& random) {
    std::uniform_real_distribution<double> at(-6, 6), exponent(-7, 2);
    lo = {at(random), at(random), at(random)};
    size = {std::exp2(exponent(random)), std::exp2(exponent(random)), std::exp2(exponent(random))};
  }
  [[nodiscard]] WorldBox box() const {
    WorldBox out;
    for (std::size_t a = 0; a < 3; ++a) {
      out[a] = {static_cast<float>(lo[a]), static_cast<float>(lo[a] + size[a])};
    }
    return out;
  }
};

/// Places at the corners of the block and anywhere in it; one y for all.
void place(graph::Machine& machine, const WorldBox& box, std::mt19937& random) {
  std::uniform_real_distribution<float> part(0, 1);
  const auto inside = [&](const Interval& range) {
    return std::clamp(range.lo + part(random) * (range.hi - range.lo), range.lo, range.hi);
  };
  for (std::size_t n = 0; n < graph::kPiece; ++n) {
    machine.x()[n] = n < 4 ? (n % 2 == 0 ? box[0].lo : box[0].hi) : inside(box[0]);
    machine.z()[n] = n < 4 ? (n / 2 == 0 ? box[2].lo : box[2].hi) : inside(box[2]);
  }
  machine.set_count(graph::kPiece);
}

/// Values are kept apart, so that all of them can be looked at after a run.
void keep_all(graph::Program& program) {
  program.n_registers = static_cast<std::uint32_t>(program.code.size());
  for (std::uint32_t n = 0; n < program.n_registers; ++n) program.homes[n] = n;
}

struct Tally {
  std::size_t n_known = 0, n_unknown = 0;
  std::size_t n_moved = 0;  ///< noises at places that several coordinates make, told closely
};

/// Whether this is a noise in a warped or turned domain whose bounds are closer than its range.
bool told_where_moved(const graph::Program& program, const graph::Instruction& noise,
                      const Interval& bound) {
  if (noise.op < graph::Op::perlin2 || noise.op > graph::Op::cellular3 || !bound.known()) {
    return false;
  }
  const graph::NoiseRange range = graph::noise_range(noise);
  const bool moved = std::any_of(noise.in.begin(), noise.in.begin() + noise.n_in, [&](auto value) {
    while (program.code[value].op == graph::Op::scale ||
           program.code[value].op == graph::Op::offset) {
      value = program.code[value].in[0];
    }
    return program.code[value].op == graph::Op::accumulate;
  });
  return moved && bound.hi - bound.lo < 0.5F * (range.hi - range.lo);
}

void expect_inside(const graph::Program& program, const Block& block, std::mt19937& random,
                   Tally& tally) {
  const WorldBox box = block.box();
  const std::vector<Interval> bounds = all_bounds(program, box);
  graph::Machine machine(program);
  place(machine, box, random);
  machine.run(program.flat());
  for (const float y : {box[1].lo, 0.3F * box[1].lo + 0.7F * box[1].hi, box[1].hi}) {
    machine.set_y(std::clamp(y, box[1].lo, box[1].hi));
    machine.run(program.deep());
    for (const graph::Instruction& i : program.code) {
      const Interval bound = bounds[i.out];
      ++(bound.known() ? tally.n_known : tally.n_unknown);
      tally.n_moved += told_where_moved(program, i, bound) ? 1 : 0;
      if (!bound.known()) continue;
      for (std::size_t n = 0; n < graph::kPiece; ++n) {
        const float v = machine.row(i.out)[n];
        ASSERT_TRUE(v >= bound.lo && v <= bound.hi)
            << "operation " << int(i.op) << " gives " << v << " at (" << machine.x()[n] << ", " << y
            << ", " << machine.z()[n] << "), not in [" << bound.lo << ", " << bound.hi << "]";
      }
    }
  }
}

TEST(Bounds, HoldEverySampleOfRandomGraphs) {
  Tally tally;
  for (std::uint32_t seed = 0; seed < 3000; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    RandomGraph source(seed, seed % 2 == 0 ? Convention::density : Convention::sdf);
    graph::Program program = graph::compile(source.graph(), source.grow(10));
    if (program.code.size() > 400) continue;
    keep_all(program);
    for (int n = 0; n < 3; ++n) expect_inside(program, Block(random), random, tally);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(tally.n_known, 2 * tally.n_unknown) << "bounds that know nothing hold everything";
}

/// A fractal of some noise, warped by another or turned.
graph::Program moved_noise(std::mt19937& random, bool warps) {
  std::uniform_real_distribution<float> part(-1, 1);
  std::uniform_int_distribution<int> kind(static_cast<int>(NodeType::value),
                                          static_cast<int>(NodeType::cellular));
  Graph g({.seed = static_cast<std::uint32_t>(random())});
  const auto noise = [&](float frequency) {
    return g.add({.type = static_cast<NodeType>(kind(random)), .numbers = {frequency, 1}});
  };
  const NodeId sum = g.add({.type = NodeType::fbm,
                            .inputs = {noise(std::exp2(part(random) - 2))},
                            .numbers = {2, 0.5F},
                            .octaves = 3});
  Node node{.type = warps ? NodeType::warp : NodeType::affine, .inputs = {sum}};
  if (warps) {
    node.inputs.push_back(noise(std::exp2(part(random) - 4)));
    node.numbers = {2 * part(random), 2, 0.5F};
  } else {
    for (int n = 0; n < 12; ++n) node.list.push_back(part(random));
  }
  return graph::compile(g, g.add(std::move(node)));
}

TEST(Bounds, HoldNoisesThatAreWarpedOrTurned) {
  for (const bool warps : {false, true}) {
    SCOPED_TRACE(warps ? "warped" : "turned");
    Tally tally;
    for (std::uint32_t seed = 0; seed < 400; ++seed) {
      SCOPED_TRACE(testing::Message() << "seed " << seed);
      std::mt19937 random(seed);
      graph::Program program = moved_noise(random, warps);
      keep_all(program);
      for (int n = 0; n < 10; ++n) expect_inside(program, Block(random), random, tally);
      if (HasFatalFailure()) return;
    }
    EXPECT_GT(tally.n_moved, 3 * 1200U) << "of 36,000 octaves";
  }
}

/// Steepness is claimed for two points anywhere; cells far apart share gradients, so a few are
/// enough.
void expect_no_steeper(graph::Op op, double slope, std::array<float, 6> p = {1}) {
  using Piece = std::array<float, graph::kPiece>;
  SCOPED_TRACE(testing::Message() << "operation " << static_cast<int>(op));
  const graph::Instruction noise{.op = op, .n_in = 3, .seed = 3, .p = p};
  std::mt19937 random(7);
  std::uniform_real_distribution<float> at(-40, 40), step(-0.02F, 0.02F);
  double steepest = 0;
  for (int n = 0; n < 1600; ++n) {
    std::array<Piece, 3> from, to;
    Piece here, there;
    for (std::size_t i = 0; i < graph::kPiece; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        from[axis][i] = at(random);
        to[axis][i] = from[axis][i] + step(random);
      }
    }
    graph::any_row(noise, &from[0][0], &from[1][0], &from[2][0], graph::kPiece, &here[0]);
    graph::any_row(noise, &to[0][0], &to[1][0], &to[2][0], graph::kPiece, &there[0]);
    for (std::size_t i = 0; i < graph::kPiece; ++i) {
      const double distance =
          std::hypot(double{from[0][i]} - to[0][i], double{from[1][i]} - to[1][i],
                     double{from[2][i]} - to[2][i]);
      if (distance <= 1e-3) continue;
      steepest = std::max(steepest, std::abs(double{there[i]} - here[i]) / distance);
    }
  }
  EXPECT_LT(steepest, slope);
  EXPECT_GT(steepest, slope * 0.25) << "a bound that loose is of no use";
}

TEST(Bounds, NoisesAreNoSteeperThanClaimed) {
  expect_no_steeper(graph::Op::perlin2, 3.2);
  expect_no_steeper(graph::Op::perlin3, 3.7);
  expect_no_steeper(graph::Op::simplex2, 7.5);
  expect_no_steeper(graph::Op::simplex3, 7.1);
  expect_no_steeper(graph::Op::open_simplex2, 9.6);
  expect_no_steeper(graph::Op::open_simplex3, 7.2);
  expect_no_steeper(graph::Op::value2, 5.32);
  expect_no_steeper(graph::Op::value3, 6.52);
  expect_no_steeper(graph::Op::value_cubic2, 3.42);
  expect_no_steeper(graph::Op::value_cubic3, 4.18);
  for (const float metric : {0.0F, 1.0F, 2.0F}) {
    const double slope = metric == 1 ? 1.75 : 1.01;
    for (const float kind : {1.0F, 2.0F, 3.0F}) {  // f1, f2, f2-f1
      const double steep = kind == 3 ? 2 * slope : slope;
      expect_no_steeper(graph::Op::cellular2, steep, {1, 1, kind, metric});
      expect_no_steeper(graph::Op::cellular3, steep, {1, 1, kind, metric});
    }
  }
}

/// Second differences along each axis, over steps that rounding does not spoil.
void expect_no_more_bent(graph::Op op, double bend) {
  using Piece = std::array<float, graph::kPiece>;
  SCOPED_TRACE(testing::Message() << "operation " << static_cast<int>(op));
  constexpr float kStep = 0x1p-5F;
  const graph::Instruction noise{.op = op, .n_in = 3, .seed = 3, .p = {1}};
  std::mt19937 random(11);
  std::uniform_real_distribution<float> anywhere(-40, 40);
  double most = 0;
  for (int n = 0; n < 3000; ++n) {
    std::array<Piece, 3> at;
    for (Piece& piece : at) {
      for (float& v : piece) v = anywhere(random);
    }
    Piece& axis = at[static_cast<std::size_t>(n % 2)];
    std::array<Piece, 3> values;
    for (Piece& value : values) {
      graph::any_row(noise, &at[0][0], &at[1][0], &at[2][0], graph::kPiece, &value[0]);
      for (float& v : axis) v += kStep;
    }
    for (std::size_t i = 0; i < graph::kPiece; ++i) {
      const double second = double{values[0][i]} - 2 * double{values[1][i]} + values[2][i];
      most = std::max(most, std::abs(second) / (double{kStep} * kStep));
    }
  }
  EXPECT_LT(most, bend);
  EXPECT_GT(most, bend * 0.4) << "a bound that loose is of no use";
}

TEST(Bounds, NoisesAreNoMoreBentThanClaimed) {
  expect_no_more_bent(graph::Op::perlin2, 12);
  expect_no_more_bent(graph::Op::perlin3, 12);
  expect_no_more_bent(graph::Op::simplex2, 55);
  expect_no_more_bent(graph::Op::simplex3, 42);
  expect_no_more_bent(graph::Op::open_simplex2, 57);
  expect_no_more_bent(graph::Op::open_simplex3, 51);
  expect_no_more_bent(graph::Op::value2, 11.6);
  expect_no_more_bent(graph::Op::value3, 11.6);
  expect_no_more_bent(graph::Op::value_cubic2, 9.7);
  expect_no_more_bent(graph::Op::value_cubic3, 9.7);
}

TEST(Bounds, TheGyroidIsNoSteeperThanClaimed) {
  const graph::Instruction gyroid{.op = graph::Op::gyroid, .n_in = 3, .p = {0, 0, 0, 1}};
  const auto sample = [&](const std::array<float, 3>& p) {
    std::array<std::array<float, graph::kRowStep>, 4> rows{};
    for (std::size_t a = 0; a < 3; ++a) rows[a].fill(p[a]);
    graph::solid_row(gyroid, rows[0].data(), rows[1].data(), rows[2].data(), 1, rows[3].data());
    return double{rows[3][0]};
  };
  std::mt19937 random(9);
  std::uniform_real_distribution<float> at(-7, 7), step(-0.01F, 0.01F);
  double steepest = 0;
  for (int n = 0; n < 400000; ++n) {
    const std::array<float, 3> a{at(random), at(random), at(random)};
    const std::array<float, 3> b{a[0] + step(random), a[1] + step(random), a[2] + step(random)};
    const double way = std::hypot(double{a[0]} - b[0], double{a[1]} - b[1], double{a[2]} - b[2]);
    if (way > 1e-3) steepest = std::max(steepest, std::abs(sample(a) - sample(b)) / way);
  }
  EXPECT_LT(steepest, 3.0);
  EXPECT_GT(steepest, 2.5);
}

Interval of(graph::Op op, Interval a, Interval b = {}, std::array<float, 6> p = {},
            bool same = false) {
  const graph::Instruction i{.op = op,
                             .in = {0, same ? 0U : 1U},
                             .n_in = static_cast<std::uint8_t>(b.known() ? 2 : 1),
                             .p = p};
  return graph::bounds_of(i, {}, a, b, {});
}

TEST(Bounds, AreTightWhereTheyCanBe) {
  const auto expect = [](Interval found, float lo, float hi) {
    EXPECT_EQ(found.lo, lo);
    EXPECT_EQ(found.hi, hi);
  };
  expect(of(graph::Op::mul, {-2, 3}, {-2, 3}, {}, true), 0, 9);
  expect(of(graph::Op::mul, {-2, 3}, {-2, 3}), -6, 9);
  expect(of(graph::Op::abs, {-2, 1}), 0, 2);
  expect(of(graph::Op::fract, {1.25F, 1.5F}), 0.25F, 0.5F);
  expect(of(graph::Op::smoothstep, {5, 9}, {}, {1, 2}), 1, 1);
  expect(of(graph::Op::mod, {7, 8}, {5, 5}), 2, 3);
  EXPECT_LT(of(graph::Op::pow, {-1, 2}, {2, 2}).hi, 4.001F);
  EXPECT_GE(of(graph::Op::pow, {-1, 2}, {2, 2}).lo, 0.0F);
  EXPECT_GT(of(graph::Op::sin, {0.1F, 0.2F}).lo, 0.0998F);
}

TEST(Bounds, DoNotVouchForWhatMayBeNoNumber) {
  EXPECT_FALSE(of(graph::Op::sqrt, {-1, 1}).known());
  EXPECT_FALSE(of(graph::Op::div, {1, 1}, {-1, 1}).known());
  EXPECT_FALSE(of(graph::Op::mul, {0, 3e38F}, {0, 3e38F}).known());
  EXPECT_FALSE(of(graph::Op::pow, {-1, 1}, {0.5F, 0.5F}).known());
  EXPECT_FALSE(of(graph::Op::abs, {}).known());
}

}  // namespace
}  // namespace mc::test
