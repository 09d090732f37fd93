// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/parallel.hpp"
#include "mc/extract.hpp"
#include "support/allocations.hpp"

namespace mc {
namespace {

/// n^3 samples of a surface that meets every plane.
std::vector<float> waves(std::int32_t n) {
  std::vector<float> samples;
  for (std::int32_t k = 0; k < n; ++k) {
    for (std::int32_t j = 0; j < n; ++j) {
      for (std::int32_t i = 0; i < n; ++i) {
        samples.push_back(std::sin(0.3F * static_cast<float>(i)) +
                          std::cos(0.2F * static_cast<float>(j)) +
                          std::sin(0.1F * static_cast<float>(k + i)));
      }
    }
  }
  return samples;
}

void expect_same(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.positions_f64, b.positions_f64);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.triangles, b.triangles);
}

/// Allocations of one call, the mesh of which is like that of the calls before.
std::uint64_t allocations_when_warm(std::int32_t n, int threads,
                                    Precision precision = Precision::f32) {
  const base::ThreadLimit limit(threads);
  const std::vector<float> samples = waves(n);
  const View3<const float> view(samples.data(), {n, n, n});
  Extractor extractor;
  Mesh mesh;
  // Which slot a slab gets is chance, where there are several threads; in the end all fit all.
  for (int round = 0; round < (threads == 1 ? 1 : 8); ++round) {
    extractor.extract(view, {.iso = 0.1, .precision = precision}, Affine{}, mesh);
  }
  const std::uint64_t before = test::n_allocations();
  extractor.extract(view, {.iso = 0.1, .precision = precision}, Affine{}, mesh);
  return test::n_allocations() - before;
}

TEST(Extractor, AllocatesNothingTheSecondTime) {
  EXPECT_EQ(allocations_when_warm(40, 1), 0U);
  EXPECT_EQ(allocations_when_warm(160, 1), 0U);  // several slabs
  EXPECT_EQ(allocations_when_warm(160, 1, Precision::f64), 0U);
}

TEST(Extractor, AllocatesPerThreadNotPerSlab) {
  EXPECT_LE(allocations_when_warm(160, 2), 40U);
  EXPECT_LE(allocations_when_warm(320, 2), 40U);  // eight times the slabs
}

TEST(Extractor, MayBeUsedForAnything) {
  Extractor extractor;
  Mesh mesh;
  const std::vector<float> large = waves(40);
  const std::vector<float> small = waves(12);
  const std::vector<double> doubles(small.begin(), small.end());
  const View3<const float> views[] = {{large.data(), {40, 40, 40}}, {small.data(), {12, 12, 12}}};
  const Affine moved = Affine::scale_translate({1, 2, 3}, {4, 5, 6});
  for (const int threads : {1, 3, 2}) {
    const base::ThreadLimit limit(threads);
    for (const View3<const float>& view : views) {
      for (const Normals normals : {Normals::gradient, Normals::none}) {
        const ExtractOptions options{.iso = 0.1, .normals = normals};
        extractor.extract(view, options, moved, mesh);
        expect_same(mesh, extract(view, options, moved));
      }
    }
    const View3<const double> view(doubles.data(), {12, 12, 12});
    extractor.extract(view, {.iso = 0.3}, Affine{}, mesh);
    expect_same(mesh, extract(view, {.iso = 0.3}));
  }
}

TEST(Extractor, PrecisionDecidesTheStore) {
  const std::vector<float> samples = waves(20);
  const View3<const float> view(samples.data(), {20, 20, 20});
  const Affine far = Affine::scale_translate({1, 1, 1}, {1e9, 0, 0});
  Extractor extractor;
  Mesh mesh;
  const Mesh single = extract(view, {.iso = 0.2});
  ASSERT_GT(single.n_vertices(), 100U);
  EXPECT_TRUE(single.positions_f64.empty());
  extractor.extract(view, {.iso = 0.2, .precision = Precision::f64}, far, mesh);
  ASSERT_TRUE(mesh.positions.empty());
  ASSERT_EQ(mesh.n_vertices(), single.n_vertices());
  EXPECT_EQ(mesh.triangles, single.triangles);
  for (std::size_t v = 0; v < mesh.n_vertices(); ++v) {
    ASSERT_NEAR(mesh.position(v)[0] - 1e9, single.position(v)[0], 1e-6);
    ASSERT_EQ(static_cast<float>(mesh.position(v)[1]), single.positions[v][1]);
  }
  extractor.extract(view, {.iso = 0.2}, Affine{}, mesh);
  expect_same(mesh, single);
}

TEST(Extractor, LooksAtTheArrayItIsGiven) {
  const std::vector<float> first = waves(20);
  std::vector<float> second = first;
  for (float& sample : second) sample = -sample;
  Extractor extractor;
  Mesh mesh;
  extractor.extract(View3<const float>(first.data(), {20, 20, 20}), {.iso = 0.2}, Affine{}, mesh);
  const View3<const float> other(second.data(), {20, 20, 20});
  extractor.extract(other, {.iso = 0.2}, Affine{}, mesh);
  expect_same(mesh, extract(other, {.iso = 0.2}));
}

TEST(Extractor, AFaultLeavesAnEmptyMesh) {
  const std::vector<float> samples = waves(8);
  Extractor extractor;
  Mesh mesh;
  extractor.extract(View3<const float>(samples.data(), {8, 8, 8}), {.iso = 1}, Affine{}, mesh);
  EXPECT_FALSE(mesh.triangles.empty());
  EXPECT_THROW(extractor.extract(View3<const float>(samples.data(), {8, 8, 1}), {}, Affine{}, mesh),
               Error);
  EXPECT_TRUE(mesh.triangles.empty());
  EXPECT_TRUE(mesh.positions.empty());
}

}  // namespace
}  // namespace mc
