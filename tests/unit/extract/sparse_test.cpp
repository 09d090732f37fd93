// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <random>

#include "base/simd_target.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/random_fields.hpp"
#include "support/reference_extractor.hpp"

// The sparse engine against the reference on the same field made dense: the same vertices bit for
// bit, the same triangles up to numbering, and its own bytes whatever the threads.

namespace mc::test {
namespace {

/// A vertex by its bits, with its normal.
using VertexBits = std::array<std::uint32_t, 6>;

VertexBits bits_of(const Mesh& mesh, std::size_t n) {
  VertexBits out{};
  std::memcpy(out.data(), mesh.positions[n].data(), 12);
  if (!mesh.normals.empty()) std::memcpy(out.data() + 3, mesh.normals[n].data(), 12);
  return out;
}

/// Triangles by the bits of their vertices, each turned so that its smallest vertex comes first.
std::vector<std::array<VertexBits, 3>> triangles_of(const Mesh& mesh) {
  std::vector<std::array<VertexBits, 3>> out;
  for (const auto& t : mesh.triangles) {
    std::array<VertexBits, 3> v{bits_of(mesh, t[0]), bits_of(mesh, t[1]), bits_of(mesh, t[2])};
    std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
    out.push_back(v);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<VertexBits> vertices_of(const Mesh& mesh) {
  std::vector<VertexBits> out;
  for (std::size_t n = 0; n < mesh.positions.size(); ++n) out.push_back(bits_of(mesh, n));
  std::sort(out.begin(), out.end());
  return out;
}

void expect_same_up_to_numbering(const Mesh& got, const Mesh& want) {
  ASSERT_EQ(vertices_of(got), vertices_of(want));
  ASSERT_EQ(triangles_of(got), triangles_of(want));
}

/// A field of blocks that are noise, or uniform on either side, so that all kinds of neighbours
/// meet. Its rim is background, as everything outside it is.
template <class T>
std::vector<T> blocky_field(Index3 dims, T background, std::uint64_t seed) {
  std::vector<T> field = random_field<T>(dims, Noise::white, seed);
  std::mt19937_64 random(seed);
  std::map<Index3, std::uint64_t> kinds;
  const T uniform[] = {background, field[0], field[1]};
  std::size_t at = 0;
  for (std::int32_t k = 0; k < dims[2]; ++k) {
    for (std::int32_t j = 0; j < dims[1]; ++j) {
      for (std::int32_t i = 0; i < dims[0]; ++i, ++at) {
        const Index3 block{i / 8, j / 8, k / 8};
        if (kinds.find(block) == kinds.end()) kinds[block] = random() % 5;
        const std::uint64_t kind = kinds[block];
        if (kind < 3) field[at] = uniform[kind];
        const bool rim =
            i < 2 || j < 2 || k < 2 || i >= dims[0] - 2 || j >= dims[1] - 2 || k >= dims[2] - 2;
        if (rim) field[at] = background;
      }
    }
  }
  return field;
}

const Affine kSkewed{{1.5, 0.25, 0, 10, 0, 2, 0.5, -20, 0.125, 0, 3, 30}};

/// The dense map that puts sample 0 where the sparse volume has its origin.
Mesh dense_reference(const std::vector<float>& samples, Index3 dims, const ExtractOptions& o) {
  return reference_extract(samples, dims, o, kSkewed);
}

TEST(SparseEngine, GivesTheDenseEnginesSurface) {
  const Index3 dims{32, 24, 24};
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE(seed);
    const float background = seed % 2 == 0 ? 0.F : 1.F;
    const auto samples = blocky_field<float>(dims, background, seed);
    ExtractOptions o;
    o.iso = 0.25;
    o.inside = seed % 4 < 2 ? Inside::above : Inside::below;
    o.normals = seed % 3 == 0 ? Normals::face : seed % 3 == 1 ? Normals::gradient : Normals::none;
    const VolumeReader reader = owned(std::unique_ptr<LeafReader>(new MemoryLeaves(
        samples, dims, {0, 0, 0}, background, kSkewed, MemoryLeaves::seeded(seed))));
    expect_same_up_to_numbering(collect(reader, o).mesh, dense_reference(samples, dims, o));
    ASSERT_FALSE(HasFatalFailure());
  }
}

// More mixed leaves than a group of bits, than a run of blocks, and than edges are remembered of.
TEST(SparseEngine, ThousandsOfLeavesAreOneSurface) {
  const Index3 dims{96, 88, 88};
  std::vector<float> samples(96 * 88 * 88, 0.F);
  std::mt19937_64 random(21);
  for (std::int32_t z = 0; z < dims[2]; z += 8) {
    for (std::int32_t y = 0; y < dims[1]; y += 8) {
      for (std::int32_t x = 0; x < dims[0]; x += 8) {
        const std::uint64_t at = random();  // one sample above in the inside of each block
        const auto within = [at](unsigned n) { return static_cast<int>(at >> (8 * n) & 3U) + 2; };
        const std::int32_t row = (z + within(2)) * dims[1] + y + within(1);
        samples[static_cast<std::size_t>(row * dims[0] + x + within(0))] = 1.F;
      }
    }
  }
  ExtractOptions o;
  o.iso = 0.25;
  const VolumeReader reader = owned(std::unique_ptr<LeafReader>(new MemoryLeaves(
      samples, dims, {0, 0, 0}, 0.F, kSkewed, [](const Index3&) { return Keep::leaf; })));
  const Collected got = collect(reader, o, {2, 0, false});
  EXPECT_EQ(got.mesh.triangles.size(), 12U * 11 * 11 * 8);
  expect_same_up_to_numbering(got.mesh, dense_reference(samples, dims, o));
}

template <class T>
class SparseTypes : public testing::Test {};
using GridTypes =
    testing::Types<std::uint8_t, std::int16_t, std::int32_t, std::int64_t, float, double>;
TYPED_TEST_SUITE(SparseTypes, GridTypes);

TYPED_TEST(SparseTypes, GiveTheReferencesSurface) {
  const Index3 dims{24, 16, 24};
  const auto background = static_cast<TypeParam>(0);
  const auto samples = blocky_field<TypeParam>(dims, background, 77);
  ExtractOptions o;
  o.iso = test_iso<TypeParam>();
  const VolumeReader reader = owned(std::unique_ptr<LeafReader>(
      new MemoryLeaves(samples, dims, {0, 0, 0}, background, Affine{}, MemoryLeaves::seeded(3))));
  expect_same_up_to_numbering(collect(reader, o).mesh, reference_extract(samples, dims, o));
}

TEST(SparseEngine, NegativeIndicesAreIndicesToo) {
  const Index3 dims{24, 24, 24};
  const auto samples = blocky_field<float>(dims, 0.F, 5);
  ExtractOptions o;
  o.iso = 0.25;
  const VolumeReader reader = owned(std::unique_ptr<LeafReader>(
      new MemoryLeaves(samples, dims, {-80, -8, -528}, 0.F, Affine{}, MemoryLeaves::sparsest())));
  expect_same_up_to_numbering(
      collect(reader, o).mesh,
      reference_extract(samples, dims, o, Affine::scale_translate({1, 1, 1}, {-80, -8, -528})));
}

TEST(SparseEngine, BytesDoNotDependOnThreads) {
  const Index3 dims{64, 64, 64};
  const auto samples = blocky_field<float>(dims, 0.F, 9);
  ExtractOptions o;
  o.iso = 0.25;
  o.measure = true;
  const VolumeReader reader = owned(std::unique_ptr<LeafReader>(
      new MemoryLeaves(samples, dims, {0, 0, 0}, 0.F, Affine{}, MemoryLeaves::seeded(4))));
  const Collected one = collect(reader, o);
  for (const int threads : {2, 3, 7}) {
    const Collected more = collect(reader, o, {threads, 0, true});
    EXPECT_EQ(more.mesh.positions, one.mesh.positions);
    EXPECT_EQ(more.mesh.normals, one.mesh.normals);
    EXPECT_EQ(more.mesh.triangles, one.mesh.triangles);
    EXPECT_EQ(more.totals.area, one.totals.area);
    EXPECT_EQ(more.totals.volume, one.totals.volume);
    EXPECT_EQ(more.object.n_triangles, one.mesh.triangles.size());
  }
}

TEST(SparseEngine, EverySimdTargetGivesTheSameBytes) {
  const Index3 dims{32, 32, 32};
  const auto samples = blocky_field<float>(dims, 0.F, 10);
  ExtractOptions o;
  o.iso = 0.25;
  const VolumeReader reader = owned(std::unique_ptr<LeafReader>(
      new MemoryLeaves(samples, dims, {0, 0, 0}, 0.F, Affine{}, MemoryLeaves::seeded(5))));
  const Collected want = collect(reader, o);
  for (const std::string& target : base::simd_targets()) {
    SCOPED_TRACE(target);
    ASSERT_TRUE(base::set_simd_target(target));
    const Collected got = collect(reader, o);
    EXPECT_EQ(got.mesh.positions, want.mesh.positions);
    EXPECT_EQ(got.mesh.triangles, want.mesh.triangles);
  }
  base::reset_simd_target();
}

TEST(SparseEngine, RegionsEqualTheDenseEnginesRegions) {
  const Index3 dims{40, 32, 32};
  const auto samples = blocky_field<float>(dims, 1.F, 12);
  const VolumeReader reader = owned(std::unique_ptr<LeafReader>(
      new MemoryLeaves(samples, dims, {0, 0, 0}, 1.F, kSkewed, MemoryLeaves::seeded(6))));
  const IndexBox regions[] = {{{3, 5, 2}, {30, 29, 27}},
                              {{8, 8, 8}, {15, 15, 15}},
                              {{7, 7, 7}, {16, 16, 16}},
                              {{1, 0, 0}, {2, 31, 31}}};
  for (const IndexBox& region : regions) {
    for (const Border border : {Border::open, Border::closed, Border::solid}) {
      for (const Normals normals : {Normals::gradient, Normals::face}) {
        SCOPED_TRACE(testing::Message() << region.lo[0] << " border " << static_cast<int>(border)
                                        << " normals " << static_cast<int>(normals));
        ExtractOptions o;
        o.iso = 0.25;
        o.border = border;
        o.normals = normals;
        o.region = region;
        o.measure = true;
        const Collected got = collect(reader, o);
        expect_same_up_to_numbering(got.mesh, dense_reference(samples, dims, o));
        ASSERT_FALSE(HasFatalFailure());
        const VolumeReader dense = owned(std::unique_ptr<SlabReader>(
            new MemorySlabs(samples, dims, MemorySlabs::Layout{.to_world = kSkewed})));
        const Collected other = collect(dense, o);
        EXPECT_EQ(got.totals.n_boundary_edges, other.totals.n_boundary_edges);
        ASSERT_EQ(got.totals.volume.has_value(), other.totals.volume.has_value());
        EXPECT_NEAR(got.totals.volume.value_or(0), other.totals.volume.value_or(0),
                    1e-9 * *other.totals.area);
        EXPECT_NEAR(*got.totals.area, *other.totals.area, 1e-9 * *other.totals.area);
      }
    }
  }
}

// A lone tile of every size that the tree has: a box with flat faces.
TEST(SparseEngine, TilesOfEverySizeHaveSurfaces) {
  for (const std::int32_t size : {8, 128}) {
    SCOPED_TRACE(size);
    auto leaves = std::make_unique<MemoryLeaves>(std::vector<float>(512, 0.F), Index3{8, 8, 8},
                                                 Index3{-800, 0, 0}, 0.F);
    leaves->add_tile({{size, -size, 0}, size, Scalar::of(1.F), true});
    const VolumeReader reader = owned(std::move(leaves));
    ExtractOptions o;
    o.iso = 0.5;
    o.measure = true;
    const Collected got = collect(reader, o);
    const auto n = static_cast<std::uint64_t>(size);
    EXPECT_EQ(got.mesh.positions.size(), 6 * n * n);
    EXPECT_EQ(got.totals.euler(), 2);
    // A cube of edge `size` whose edges are cut off to half a cell; corners to sixths.
    const double edge = size;
    EXPECT_NEAR(*got.totals.volume, edge * edge * edge - 12 * 0.125 * (edge - 1) - 8 * 5.0 / 48,
                1e-6 * edge * edge * edge);
  }
}

TEST(SparseEngine, TilesThatTouchAreOneSolid) {
  auto leaves = std::make_unique<MemoryLeaves>(std::vector<float>(512, 1.F), Index3{8, 8, 8},
                                               Index3{0, 0, 0}, 0.F);
  leaves->add_tile({{8, 0, 0}, 8, Scalar::of(1.F), true});
  leaves->add_tile({{128, 0, 0}, 128, Scalar::of(1.F), false});
  for (std::int32_t x = 16; x < 128; x += 8) {
    leaves->add_tile({{x, 0, 0}, 8, Scalar::of(2.F), false});
  }
  const VolumeReader reader = owned(std::move(leaves));
  ExtractOptions o;
  o.iso = 0.5;
  const Collected got = collect(reader, o);
  EXPECT_EQ(got.totals.euler(), 2);
  EXPECT_EQ(got.totals.n_boundary_edges, 0U);
}

// 4096 samples wide, and nobody walks through its inside: this would take minutes otherwise.
TEST(SparseEngine, ARootTileCostsItsFaces) {
  auto leaves = std::make_unique<MemoryLeaves>(std::vector<float>(512, 0.F), Index3{8, 8, 8},
                                               Index3{-8, 0, 0}, 0.F);
  leaves->add_tile({{0, 0, 0}, 4096, Scalar::of(1.F), true});
  const VolumeReader reader = owned(std::move(leaves));
  ExtractOptions o;
  o.iso = 0.5;
  o.region = IndexBox{{-4, -4, -4}, {20, 20, 20}};
  const Collected got = collect(reader, o);
  EXPECT_GT(got.totals.n_triangles, 3U * 20 * 20 * 2);
  EXPECT_GT(got.totals.n_boundary_edges, 0U);
}

}  // namespace
}  // namespace mc::test
