// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "base/simd_target.hpp"
#include "graph/noise_range.hpp"
#include "graph/rows.hpp"
#include "support/cell_twins.hpp"

// The kernels of the noises against their plain twins, bit for bit, on every SIMD target.

namespace mc::tests {
namespace {

using graph::Instruction;
using graph::kPiece;
using graph::Op;
using Rows = std::array<std::vector<float>, 3>;

constexpr std::uint32_t kSeed = 0xC0FFEE;

struct Kernel {
  std::string name;
  Instruction instruction;
  std::function<float(float, float, float)> twin;
};

Instruction instruction_of(Op op) { return {.op = op, .n_in = 3, .seed = kSeed, .p = {0.75F}}; }

/// Cellular noise, all that it can tell in all metrics.
void add_cellular(std::vector<Kernel>& all, bool flat, float jitter) {
  for (const CellMetric metric :
       {CellMetric::euclidean, CellMetric::manhattan, CellMetric::chebyshev}) {
    for (const CellReturn what :
         {CellReturn::value, CellReturn::f1, CellReturn::f2, CellReturn::f2_f1}) {
      Node node;
      node.numbers[1] = jitter;
      node.cell_return = what;
      node.cell_metric = metric;
      Instruction instruction = instruction_of(flat ? Op::cellular2 : Op::cellular3);
      instruction.p = {0.75F, jitter, static_cast<float>(what), static_cast<float>(metric)};
      all.push_back({"cellular " + std::to_string(int(metric)) + std::to_string(int(what)),
                     instruction, [=](float x, float y, float z) {
                       const bool nan = x != x || y != y || (!flat && z != z);
                       return nan ? NAN : twin::cellular(node, flat, x, y, z, kSeed);
                     }});
    }
  }
}

template <class F>
void add_flat(std::vector<Kernel>& all, const char* name, Op op, F f) {
  all.push_back(
      {name, instruction_of(op), [=](float x, float y, float) { return f(x, y, kSeed); }});
}
template <class F>
void add_deep(std::vector<Kernel>& all, const char* name, Op op, F f) {
  all.push_back(
      {name, instruction_of(op), [=](float x, float y, float z) { return f(x, y, z, kSeed); }});
}

const std::vector<Kernel>& kernels() {
  static const std::vector<Kernel> kAll = [] {
    std::vector<Kernel> all;
    add_flat(all, "perlin2", Op::perlin2, twin::perlin2);
    add_deep(all, "perlin3", Op::perlin3, twin::perlin3);
    add_flat(all, "simplex2", Op::simplex2,
             [](float x, float y, std::uint32_t s) { return twin::simplex2(x, y, s); });
    add_deep(all, "simplex3", Op::simplex3, twin::simplex3);
    add_flat(all, "open_simplex2", Op::open_simplex2, twin::open_simplex2);
    add_deep(all, "open_simplex3", Op::open_simplex3, twin::open_simplex3);
    add_flat(all, "unity2", Op::unity2,
             [](float x, float y, std::uint32_t) { return twin::unity2(x, y); });
    add_flat(all, "white2", Op::white2,
             [](float x, float y, std::uint32_t s) { return twin::white(x, y, -0.5F, s); });
    add_deep(all, "white3", Op::white3, twin::white);
    add_flat(all, "value2", Op::value2, twin::value2);
    add_deep(all, "value3", Op::value3, twin::value3);
    add_flat(all, "value_cubic2", Op::value_cubic2, twin::value_cubic2);
    add_deep(all, "value_cubic3", Op::value_cubic3, twin::value_cubic3);
    add_cellular(all, true, 1);
    add_cellular(all, false, 1);
    add_cellular(all, false, 0.6F);
    return all;
  }();
  return kAll;
}

bool same(float a, float b) {
  return (a != a && b != b) || std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

void expect_twins(const Rows& rows, std::size_t n, std::span<const Kernel> among = kernels()) {
  for (const Kernel& kernel : among) {
    const graph::NoiseRange range = graph::noise_range(kernel.instruction);
    std::vector<float> wanted(n);
    for (std::size_t i = 0; i < n; ++i) {
      wanted[i] = kernel.twin(rows[0][i] * 0.75F, rows[1][i] * 0.75F, rows[2][i] * 0.75F);
      ASSERT_FALSE(wanted[i] < range.lo || wanted[i] > range.hi) << kernel.name << wanted[i];
    }
    for (const std::string& target : base::simd_targets()) {
      ASSERT_TRUE(base::set_simd_target(target));
      std::vector<float> out(kPiece);
      graph::any_row(kernel.instruction, rows[0].data(), rows[1].data(), rows[2].data(), n,
                     out.data());
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_TRUE(same(out[i], wanted[i]))
            << kernel.name << " on " << target << " at " << rows[0][i] << ", " << rows[1][i] << ", "
            << rows[2][i] << ": " << out[i] << ", but " << wanted[i];
      }
    }
  }
  base::reset_simd_target();
}

/// Rows with room for whole vectors.
template <class F>
Rows rows_of(F f) {
  Rows rows;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < kPiece; ++i) {
      rows[axis].push_back(f(axis, i));
    }
  }
  return rows;
}

TEST(NoiseRows, ScatteredPlacesAreThoseOfTheTwins) {
  std::mt19937 random(11);
  for (const float size : {1.0F, 40.0F, 1e6F, 3e9F}) {
    std::uniform_real_distribution<float> place(-size, size);
    expect_twins(rows_of([&](std::size_t, std::size_t) { return place(random); }), kPiece);
  }
}

TEST(NoiseRows, LatticePointsZerosAndWhatIsNoNumberToo) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const float odd[] = {0.0F,  -0.0F, 4.0F,      -4.0F,      -1e-9F,
                       1e-9F, 1e30F, kInfinity, -kInfinity, std::nanf("")};
  std::mt19937 random(12);
  expect_twins(rows_of([&](std::size_t, std::size_t) { return odd[random() % std::size(odd)]; }),
               kPiece);
}

// As a lattice lays them: x rises evenly, y and z stay. The two Perlin noises, first in the list,
// know such rows.
TEST(NoiseRows, RowsAlongXAreThoseOfTheTwins) {
  const std::array<std::array<float, 2>, 6> rest{
      {{0, 0}, {4, -8}, {-0.0F, 1.3F}, {-2.37F, 5.1F}, {1e7F, -3.3F}, {NAN, 1}}};
  for (const float step : {0.001F, 0.05F, 0.37F, 1.0F, 2.9F, 500.0F, -0.21F, 0.0F}) {
    for (const float start : {-0.0F, -7.77F, -1e-8F}) {
      for (const auto& yz : rest) {
        expect_twins(rows_of([&](std::size_t axis, std::size_t i) {
                       return axis == 0 ? start + static_cast<float>(i) * step : yz[axis - 1];
                     }),
                     kPiece - 13, std::span(kernels()).first(2));
      }
    }
  }
}

}  // namespace
}  // namespace mc::tests
