// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "graph/bounds.hpp"
#include "graph/compile.hpp"
#include "graph/machine.hpp"
#include "graph/ops.hpp"
#include "graph/prune.hpp"
#include "graph/reduce.hpp"
#include "graph/rows.hpp"
#include "unit/graph/graph_support.hpp"

// What becomes of a graph on its way to instructions, and of these in a block: less, with the same
// bits.

namespace mc::tests {
namespace {

using graph::Instruction;
using graph::Interval;
using graph::Op;

std::size_t count(const graph::Program& program, Op op) {
  return static_cast<std::size_t>(std::count_if(program.code.begin(), program.code.end(),
                                                [op](const auto& i) { return i.op == op; }));
}

TEST(Program, RunsConstantsWhenItIsCompiled) {
  Graph graph({});
  const NodeId two = graph.add(make(NodeType::constant, {}, {2}));
  const NodeId three = graph.add(make(NodeType::constant, {}, {3}));
  const NodeId power = graph.add(make(NodeType::pow, {two, three}));
  const NodeId root = graph.add(make(NodeType::sqrt, {power}));
  const graph::Program program = graph::compile(graph, root);
  ASSERT_EQ(program.code.size(), 1U);
  EXPECT_EQ(program.code[0].op, Op::fill);
  EXPECT_EQ(program.code[0].p[0], std::sqrt(8.0F));
}

TEST(Program, RunsEqualNodesOnce) {
  Graph graph({});
  const auto noise = [&] { return graph.add(make(NodeType::perlin, {}, {0.5F})); };
  const auto half = [&] {
    return graph.add(make(NodeType::abs, {graph.add(make(NodeType::neg, {noise()}))}));
  };
  const graph::Program program =
      graph::compile(graph, graph.add(make(NodeType::min, {half(), half()})));
  EXPECT_EQ(count(program, Op::perlin3), 1U);
  EXPECT_EQ(count(program, Op::neg), 1U);
  EXPECT_EQ(count(program, Op::abs), 1U);
}

TEST(Program, KeepsWhatDoesNotDependOnYApart) {
  Graph graph({});
  const NodeId y = graph.add(make(NodeType::y));
  Node noise = make(NodeType::perlin, {}, {0.5F});
  noise.dims = Dims::xz;
  const NodeId hills = graph.add(noise);
  const NodeId root = graph.add(make(NodeType::sub, {hills, graph.add(make(NodeType::sqrt, {y}))}));
  const graph::Program program = graph::compile(graph, root);
  ASSERT_EQ(program.flat().size(), 3U);  // x, z, noise
  ASSERT_EQ(program.deep().size(), 3U);  // y, sqrt, difference
  EXPECT_TRUE(program.uniform[program.deep()[1].out]);
  EXPECT_FALSE(program.uniform[program.result]);
}

/// Runs one instruction at many inputs.
std::vector<float> values(const Instruction& instruction, std::span<const std::vector<float>> in) {
  std::vector<float> out(graph::kPiece);
  const auto row = [&](std::size_t n) { return in[instruction.in[n]].data(); };
  if (instruction.op == Op::copy) return in[instruction.in[0]];
  graph::any_row(instruction, row(0), row(1), row(2), out.size(), out.data());
  return out;
}

/// Numbers that meet each other and zeros of both signs.
float coarse(std::mt19937& random) {
  const float v = 0.5F * static_cast<float>(std::uniform_int_distribution<int>(-6, 6)(random));
  return v == 0 && random() % 2 == 0 ? -0.0F : v;
}

TEST(Program, TakesNumbersIntoInstructionsBitByBit) {
  std::mt19937 random(11);
  for (int n = 0; n < 400; ++n) {
    const Op op = std::array{Op::add, Op::sub, Op::mul}[random() % 3];
    std::vector<std::vector<float>> in(3, std::vector<float>(graph::kPiece));
    std::generate(in[0].begin(), in[0].end(), [&] { return coarse(random); });
    const float number = coarse(random);
    std::fill(in[1].begin(), in[1].end(), number);
    const bool swapped = random() % 2 == 0;
    const Instruction whole{
        .op = op, .out = 2, .in = {swapped ? 1U : 0U, swapped ? 0U : 1U}, .n_in = 2};
    const std::vector<Instruction> code{{.op = Op::x, .out = 0},
                                        {.op = Op::fill, .out = 1, .p = {number}}};
    const Instruction less = graph::reduced(whole, code);
    EXPECT_EQ(less.n_in, 1);
    EXPECT_EQ(hash_bits(values(less, in)), hash_bits(values(whole, in)));
  }
}

TEST(Pruning, LeavesEveryBit) {
  constexpr std::array kOps{Op::min,        Op::max,   Op::smooth_min, Op::smooth_max,
                            Op::smoothstep, Op::clamp, Op::abs,        Op::mix};
  std::mt19937 random(5);
  std::size_t n_simpler = 0;
  for (int n = 0; n < 20000; ++n) {
    Instruction whole{.op = kOps[random() % kOps.size()], .out = 3, .in = {0, 1, 2}};
    whole.n_in = graph::row_of(whole.op).n_inputs;
    whole.p = {std::abs(coarse(random)) + 0.25F, 0};
    whole.p[1] = whole.p[0] + 1;
    std::array<Interval, 3> bounds;
    std::vector<std::vector<float>> in(3, std::vector<float>(graph::kPiece));
    for (std::size_t i = 0; i < 3; ++i) {
      const float a = coarse(random), b = random() % 3 == 0 ? a : coarse(random);
      bounds[i] = {std::min(a, b), std::max(a, b)};
      for (float& v : in[i]) {
        do v = coarse(random);
        while (!(v >= bounds[i].lo && v <= bounds[i].hi));
      }
    }
    const Interval value = graph::bounds_of(whole, {}, bounds[0], bounds[1], bounds[2]);
    const Instruction less = graph::simplified(whole, bounds, value);
    n_simpler += less.op != whole.op ? 1 : 0;
    ASSERT_EQ(hash_bits(values(less, in)), hash_bits(values(whole, in)))
        << "operation " << int(whole.op) << " as " << int(less.op);
  }
  EXPECT_GT(n_simpler, 5000U);
}

TEST(Pruning, DropsWhatOnlyTheLosingBranchNeeds) {
  Graph graph({});
  const NodeId noise = graph.add(make(NodeType::perlin, {}, {0.5F}));
  const NodeId far = graph.add(make(NodeType::plane, {}, {0, 1, 0, -50}));
  const NodeId y = graph.add(make(NodeType::y));
  const NodeId near = graph.add(make(NodeType::add, {noise, y}));
  const graph::Program program =
      graph::compile(graph, graph.add(make(NodeType::unite, {near, far}, {2})));
  std::vector<Interval> bounds;
  for (const Instruction& i : program.code) {
    const auto at = [&](std::size_t n) { return n < i.n_in ? bounds[i.in[n]] : Interval{}; };
    bounds.push_back(graph::bounds_of(i, {{{0, 9}, {0, 9}, {0, 9}}}, at(0), at(1), at(2)));
  }
  std::vector<Instruction> shorter;
  graph::Pruner(program).prune(program.code, bounds, shorter);
  EXPECT_EQ(std::count_if(shorter.begin(), shorter.end(),
                          [](const auto& i) { return i.op == Op::plane; }),
            0);
  EXPECT_EQ(std::count_if(shorter.begin(), shorter.end(),
                          [](const auto& i) { return i.op == Op::perlin3; }),
            1);
}

}  // namespace
}  // namespace mc::tests
