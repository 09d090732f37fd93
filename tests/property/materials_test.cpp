// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/simd_target.hpp"
#include "source/spec/spec.hpp"
#include "support/mesh_collector.hpp"
#include "support/random_graphs.hpp"

// Materials of vertices depend on where the vertices are, and on nothing else; and fields sampled
// at scattered places have the bits that they have on a lattice.

namespace mc::test {
namespace {

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}

TEST(Places, HaveTheBitsOfTheLattice) {
  constexpr Index3 kDims{7, 6, 9};
  for (std::uint32_t seed = 0; seed < 300 && !HasFailure(); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    RandomGraph source(seed, Convention::density);
    const NodeId root = source.grow(8);
    const GraphField field = source.graph().compile(root);
    std::vector<float> lattice(7 * 6 * 9);
    field.sample({-1.5, -0.75, -1}, {0.5, 0.25, 0.375}, {0, 0, 0}, {lattice.data(), kDims});
    std::vector<std::size_t> order(lattice.size());
    for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
    std::vector<std::array<float, 3>> places;
    for (const std::size_t n : order) {
      places.push_back({-1.5F + 0.5F * static_cast<float>(n % 7),
                        -0.75F + 0.25F * static_cast<float>(n / 7 % 6),
                        -1.0F + 0.375F * static_cast<float>(n / 42)});
    }
    std::vector<float> values(places.size());
    field.sample_places(places, values);
    for (std::size_t n = 0; n < order.size(); ++n) {
      ASSERT_TRUE(same_bits(values[n], lattice[order[n]])) << values[n] << lattice[order[n]];
    }
  }
}

constexpr const char* kDocument = R"({"format": "mc-volume", "version": 1,
  "grid": {"cells": [40, 24, 33], "spacing": 0.5, "origin": [-9, -5, -8]}, "border": "closed",
  "field": {"type": "add", "inputs": [{"type": "perlin", "frequency": 0.3}, {"type": "mul", "inputs": [-0.1, "y"]}]},
  "material": {"type": "mul", "inputs": [6, {"type": "simplex", "frequency": 0.4}]}})";

void expect_same_materials(const Collected& a, const Collected& b) {
  ASSERT_EQ(a.mesh.positions.size(), b.mesh.positions.size());
  EXPECT_TRUE(a.materials == b.materials);
  EXPECT_EQ(a.totals.n_clamped, b.totals.n_clamped);
}

TEST(Materials, DoNotDependOnThreadsSlabsOrTarget) {
  constexpr std::array<How, 5> kHows{{{.threads = 1, .count_first = true},
                                      {.threads = 2, .chunk_bytes = 1},
                                      {.threads = 2, .slab_layers = 3},
                                      {.threads = 3, .skip = false},
                                      {.threads = 7, .slab_layers = 1}}};
  const VolumeReader reader = owned(source::open_spec_text("m.json", kDocument));
  const ExtractOptions options{.border = Border::closed};
  const Collected first = collect(reader, options);
  ASSERT_EQ(first.materials.size(), first.mesh.positions.size());
  EXPECT_GT(first.totals.n_clamped.at(0), 0U);
  EXPECT_LT(first.totals.n_clamped.at(0), first.materials.size());
  for (const How& how : kHows) expect_same_materials(collect(reader, options, how), first);
  for (const std::string& target : base::simd_targets()) {
    SCOPED_TRACE(target);
    ASSERT_TRUE(base::set_simd_target(target));
    expect_same_materials(collect(reader, options), first);
  }
  base::reset_simd_target();
}

}  // namespace
}  // namespace mc::test
