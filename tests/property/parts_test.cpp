// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <random>
#include <set>
#include <vector>

#include "mc/pipe.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/random_fields.hpp"
#include "support/same_mesh.hpp"

// Laws of parts, over random fields, options, cuts and threads: the meshes of the parts, put one
// after the other, are the mesh of the whole, byte for byte, and a part reads little more than its
// own samples.

namespace mc::test {
namespace {

const Affine kSkewed{{1.5, 0.25, 0, 10, 0, 2, 0.5, -20, 0.125, 0, 3, 30}};

RunOptions run_options(const ExtractOptions& extract) {
  RunOptions options;
  options.extract = extract;
  return options;
}

/// Cuts a range at random layers, which may coincide: then a part is empty.
std::vector<LayerRange> random_cuts(const LayerRange& all, std::mt19937_64& random) {
  std::vector<std::int32_t> cuts{all.first, all.last};
  const auto n = static_cast<std::uint64_t>(all.last - all.first) + 1;
  for (int c = 0; c < 4; ++c) cuts.push_back(all.first + static_cast<std::int32_t>(random() % n));
  std::ranges::sort(cuts);
  std::vector<LayerRange> out;
  for (std::size_t c = 1; c < cuts.size(); ++c) out.push_back({cuts[c - 1], cuts[c]});
  return out;
}

/// Puts a part's mesh behind those before it, and adds up all figures.
void append(const Collected& part, Collected& all) {
  append_mesh(part, all);
  all.totals.n_boundary_edges += part.totals.n_boundary_edges;
  all.totals.bounds.include(part.totals.bounds);
  all.totals.area = all.totals.area.value_or(0) + part.totals.area.value_or(0);
}

void expect_same(const Collected& got, const Collected& want) {
  expect_same_mesh(got, want);
  ASSERT_EQ(got.totals.n_boundary_edges, want.totals.n_boundary_edges);
  ASSERT_EQ(got.totals.bounds.lo, want.totals.bounds.lo);
  ASSERT_EQ(got.totals.bounds.hi, want.totals.bounds.hi);
  if (want.totals.area) {
    ASSERT_NEAR(*got.totals.area, *want.totals.area, 1e-12 * *want.totals.area);
  }
}

/// Meshes the whole, and random parts on 1, 2 and 7 threads, with and without a counting pass.
void compare_parts(const VolumeReader& reader, const ExtractOptions& options, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Collected whole = collect(reader, options);
  const LayerRange all = part_layers(reader, run_options(options));
  for (const int threads : {1, 2, 7}) {
    Collected joined;
    for (const LayerRange& part : random_cuts(all, random)) {
      SCOPED_TRACE(testing::Message() << "layers " << part.first << " to " << part.last << " on "
                                      << threads << " threads");
      ExtractOptions o = options;
      o.part = part;
      How how{.threads = threads, .slab_layers = static_cast<std::int32_t>(random() % 4)};
      how.count_first = random() % 2 == 0;
      how.chunk_bytes = random() % 3 == 0 ? 4096 : 0;
      const Collected got = collect(reader, o, how);
      ASSERT_EQ(got.totals.n_vertices, got.mesh.positions.size() + got.mesh.positions_f64.size());
      if (how.count_first) {
        ASSERT_EQ(got.object.n_vertices, got.totals.n_vertices);
        ASSERT_EQ(got.object.n_triangles, got.totals.n_triangles);
      }
      append(got, joined);
    }
    expect_same(joined, whole);
    ASSERT_FALSE(testing::Test::HasFatalFailure());
  }
}

ExtractOptions random_options(double iso, const IndexBox& region, std::uint64_t seed) {
  ExtractOptions o{.iso = iso};
  o.inside = seed % 2 == 0 ? Inside::above : Inside::below;
  o.border = Border(seed % 3);
  o.normals = Normals(seed / 3 % 3);
  o.precision = seed % 5 == 0 ? Precision::f64 : Precision::f32;
  if (seed % 4 == 0) o.region = region;
  if (seed % 7 == 0) o.origin = {1, 2, -3};
  o.measure = seed % 2 == 1;
  return o;
}

template <class T>
class DenseLayerParts : public testing::Test {};
using SampleTypes = testing::Types<std::uint8_t, std::int16_t, std::uint32_t, float, double>;
TYPED_TEST_SUITE(DenseLayerParts, SampleTypes);

TYPED_TEST(DenseLayerParts, PutTogetherAreTheWhole) {
  const Index3 dims{21, 9, 17};
  for (std::uint64_t seed = 1; seed <= 36; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const auto samples = random_field<TypeParam>(dims, Noise(seed % 4), seed);
    const VolumeReader reader =
        owned(std::unique_ptr<SlabReader>(new MemorySlabs(samples, dims, kSkewed)));
    compare_parts(reader, random_options(test_iso<TypeParam>(), {{2, 1, 3}, {18, 8, 14}}, seed),
                  seed);
    ASSERT_FALSE(this->HasFatalFailure());
  }
}

template <class T>
class SparseLayerParts : public testing::Test {};
using GridTypes = testing::Types<std::int32_t, float, double>;
TYPED_TEST_SUITE(SparseLayerParts, GridTypes);

TYPED_TEST(SparseLayerParts, PutTogetherAreTheWhole) {
  const Index3 dims{32, 24, 56};
  for (std::uint64_t seed = 1; seed <= 36; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const auto background = static_cast<TypeParam>(seed % 4 < 2 ? 0 : 5);
    const std::vector<TypeParam> noise = random_field<TypeParam>(dims, Noise::white, seed);
    auto leaves = std::make_unique<MemoryLeaves>(
        blocky_field<TypeParam>(dims, Noise::white, {background, noise[0], noise[1]}, seed), dims,
        Index3{-16, 0, -24}, background, kSkewed, MemoryLeaves::seeded(seed));
    if (seed % 3 == 0) leaves->add_tile({{128, 0, -128}, 128, Scalar::of(TypeParam{5}), true});
    const VolumeReader reader = owned(std::unique_ptr<LeafReader>(std::move(leaves)));
    compare_parts(reader, random_options(test_iso<TypeParam>(), {{-9, 3, -17}, {12, 20, 25}}, seed),
                  seed);
    ASSERT_FALSE(this->HasFatalFailure());
  }
}

/// Remembers which planes were asked for.
class WatchedSlabs final : public SlabReader {
 public:
  explicit WatchedSlabs(const SlabReader& slabs) : slabs_(slabs) {}
  [[nodiscard]] const Volume& volume() const override { return slabs_.volume(); }
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override {
    const std::lock_guard lock(mutex_);
    for (std::int32_t k = k0; k < k1; ++k) asked.insert(k);
    slabs_.read(k0, k1, out);
  }
  [[nodiscard]] bool rereads_cheaply() const override { return true; }

  mutable std::set<std::int32_t> asked;

 private:
  const SlabReader& slabs_;
  mutable std::mutex mutex_;
};

TEST(LayerParts, ReadOnePlaneMoreOnBothSidesForNormals) {
  const Index3 dims{8, 8, 30};
  const MemorySlabs slabs(random_field<float>(dims, Noise::white, 1), dims);
  auto watched = std::make_unique<WatchedSlabs>(slabs);
  const WatchedSlabs& seen = *watched;
  const VolumeReader reader = owned(std::unique_ptr<SlabReader>(std::move(watched)));
  ExtractOptions o{.iso = 0.25};
  o.part = LayerRange{10, 14};
  collect(reader, o);
  EXPECT_EQ(seen.asked, (std::set<std::int32_t>{9, 10, 11, 12, 13, 14, 15}));
}

/// Remembers from which layers of blocks values were asked for.
class WatchedLeaves final : public LeafReader {
 public:
  explicit WatchedLeaves(const LeafReader& leaves) : leaves_(leaves) {}
  [[nodiscard]] const Volume& volume() const override { return leaves_.volume(); }
  [[nodiscard]] Scalar background() const override { return leaves_.background(); }
  [[nodiscard]] std::span<const Index3> leaves() const override { return leaves_.leaves(); }
  const std::byte* leaf_values(std::size_t n, std::byte* scratch) const override {
    const std::lock_guard lock(mutex_);
    asked.insert(leaves()[n][2] / 8);
    return leaves_.leaf_values(n, scratch);
  }
  [[nodiscard]] std::array<std::uint64_t, 8> leaf_active(std::size_t n) const override {
    return leaves_.leaf_active(n);
  }
  [[nodiscard]] std::span<const Tile> tiles() const override { return leaves_.tiles(); }

  mutable std::set<std::int32_t> asked;

 private:
  const LeafReader& leaves_;
  mutable std::mutex mutex_;
};

TEST(LayerParts, ReadLeavesOfTheLayerBelowAndOfTwoAbove) {
  const Index3 dims{16, 16, 80};
  const MemoryLeaves leaves(random_field<float>(dims, Noise::white, 1), dims, {0, 0, 0}, 0.F);
  for (const Normals normals : {Normals::gradient, Normals::none}) {
    auto watched = std::make_unique<WatchedLeaves>(leaves);
    const WatchedLeaves& seen = *watched;
    const VolumeReader reader = owned(std::unique_ptr<LeafReader>(std::move(watched)));
    ExtractOptions o{.iso = 0.25};
    o.normals = normals;
    o.part = LayerRange{4, 6};
    collect(reader, o);
    std::set<std::int32_t> expected{4, 5, 6, 7};
    if (normals == Normals::gradient) expected.insert(3);
    EXPECT_EQ(seen.asked, expected);
  }
}

TEST(LayerParts, AreCountedFromTheFirstLayerWithASurface) {
  const Index3 dims{16, 16, 80};
  const auto samples = random_field<float>(dims, Noise::white, 1);
  const VolumeReader dense = owned(std::unique_ptr<SlabReader>(new MemorySlabs(samples, dims)));
  ExtractOptions o{.iso = 0.25};
  EXPECT_EQ(part_layers(dense, run_options(o)), (LayerRange{0, 79}));
  o.border = Border::closed;
  EXPECT_EQ(part_layers(dense, run_options(o)), (LayerRange{0, 81}));
  const VolumeReader sparse =
      owned(std::unique_ptr<LeafReader>(new MemoryLeaves(samples, dims, {0, 0, -16}, 0.F)));
  EXPECT_EQ(part_layers(sparse, run_options(o)), (LayerRange{-3, 8}));
  o.region = IndexBox{{0, 0, -8}, {15, 15, 7}};
  EXPECT_EQ(part_layers(sparse, run_options(o)), (LayerRange{-2, 2}));
  o.border = Border::open;
  EXPECT_EQ(part_layers(sparse, run_options(o)), (LayerRange{-1, 1}));
}

TEST(LayerParts, OutsideTheLayersAreRefused) {
  const Index3 dims{4, 4, 9};
  const VolumeReader reader =
      owned(std::unique_ptr<SlabReader>(new MemorySlabs(std::vector<float>(4 * 4 * 9), dims)));
  ExtractOptions o;
  for (const LayerRange part : {LayerRange{-1, 3}, LayerRange{3, 9}, LayerRange{5, 4}}) {
    o.part = part;
    try {
      collect(reader, o);
      ADD_FAILURE() << part.first;
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::usage);
    }
  }
}

}  // namespace
}  // namespace mc::test
