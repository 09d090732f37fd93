// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

#include "extract/simd_target.hpp"
#include "graph/noise_range.hpp"
#include "graph/rows.hpp"
#include "support/noise_twins.hpp"

// The kernels of the noises against their plain twins, bit for bit, on every SIMD target.

namespace mc::tests {
namespace {

using graph::Instruction;
using graph::kPiece;
using graph::Op;
using Rows = std::array<std::vector<float>, 3>;

constexpr std::uint32_t kSeed = 0xC0FFEE;

struct Kernel {
  const char* name;
  Op op;
  std::function<float(float, float, float)> twin;
};

const std::vector<Kernel>& kernels() {
  static const std::vector<Kernel> kAll{
      {"perlin2", Op::perlin2, [](float x, float y, float) { return twin::perlin2(x, y, kSeed); }},
      {"perlin3", Op::perlin3,
       [](float x, float y, float z) { return twin::perlin3(x, y, z, kSeed); }},
      {"simplex2", Op::simplex2,
       [](float x, float y, float) { return twin::simplex2(x, y, kSeed); }},
      {"simplex3", Op::simplex3,
       [](float x, float y, float z) { return twin::simplex3(x, y, z, kSeed); }},
      {"unity2", Op::unity2, [](float x, float y, float) { return twin::unity2(x, y); }},
  };
  return kAll;
}

bool same(float a, float b) {
  return (a != a && b != b) || std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

void expect_twins(const Rows& rows, std::size_t n) {
  for (const std::string& target : extraction::simd_targets()) {
    ASSERT_TRUE(extraction::set_simd_target(target));
    for (const Kernel& kernel : kernels()) {
      const Instruction instruction{.op = kernel.op, .n_in = 3, .seed = kSeed, .p = {0.75F}};
      std::vector<float> out(kPiece);
      graph::gradient_row(instruction, rows[0].data(), rows[1].data(), rows[2].data(), n,
                          out.data());
      const graph::NoiseRange range = graph::noise_range(instruction);
      for (std::size_t i = 0; i < n; ++i) {
        ASSERT_FALSE(out[i] < range.lo || out[i] > range.hi) << kernel.name << ": " << out[i];
        const float wanted =
            kernel.twin(rows[0][i] * 0.75F, rows[1][i] * 0.75F, rows[2][i] * 0.75F);
        ASSERT_TRUE(same(out[i], wanted))
            << kernel.name << " on " << target << " at " << rows[0][i] << ", " << rows[1][i] << ", "
            << rows[2][i] << ": " << out[i] << ", but " << wanted;
      }
    }
  }
  extraction::reset_simd_target();
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

// As a lattice lays them: x rises evenly, y and z stay.
TEST(NoiseRows, RowsAlongXAreThoseOfTheTwins) {
  const std::array<std::array<float, 2>, 6> rest{
      {{0, 0}, {4, -8}, {-0.0F, 1.3F}, {-2.37F, 5.1F}, {1e7F, -3.3F}, {NAN, 1}}};
  for (const float step : {0.001F, 0.05F, 0.37F, 1.0F, 4.0F / 3, 2.9F, 500.0F, -0.21F, 0.0F}) {
    for (const float start : {-0.0F, -7.77F, -1e-8F, 123456.0F}) {
      for (const auto& yz : rest) {
        expect_twins(rows_of([&](std::size_t axis, std::size_t i) {
                       return axis == 0 ? start + static_cast<float>(i) * step : yz[axis - 1];
                     }),
                     kPiece - 13);
      }
    }
  }
}

}  // namespace
}  // namespace mc::tests
