// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <queue>
#include <set>
#include <vector>

#include "mc/components.hpp"
#include "mc/pipe.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/random_fields.hpp"
#include "support/same_mesh.hpp"

// Laws of components, over random fields: what remains is the mesh of a field in which every other
// component is replaced by samples that are not solid. Components come from a plain flood fill of
// the dense samples, their sizes from meshes of one component each.

namespace mc::test {
namespace {

const Affine kSkewed{{1.5, 0.25, 0, 10, 0, 2, 0.5, -20, 0.125, 0, 3, 30}};

/// Components of a dense array by flood fill, numbered in the order of their first samples.
class Flood {
 public:
  Flood(const std::vector<bool>& solid, Index3 dims, bool diagonal) : dims_(dims) {
    label.assign(solid.size(), -1);
    for (std::size_t s = 0; s < solid.size(); ++s) {
      if (solid[s] && label[s] < 0) fill(solid, s, diagonal);
    }
  }

  std::vector<int> label;  ///< of each sample; -1 where it is not solid
  int n = 0;

 private:
  void fill(const std::vector<bool>& solid, std::size_t first, bool diagonal) {
    std::queue<std::size_t> wait;
    wait.push(first);
    label[first] = n;
    while (!wait.empty()) {
      const auto at = static_cast<std::int32_t>(wait.front());
      wait.pop();
      const Index3 p{at % dims_[0], at / dims_[0] % dims_[1], at / (dims_[0] * dims_[1])};
      for (int d = 0; d < 27; ++d) {
        const Index3 step{d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1};
        const int length = std::abs(step[0]) + std::abs(step[1]) + std::abs(step[2]);
        if (length == 0 || length > (diagonal ? 2 : 1)) continue;
        const Index3 q{p[0] + step[0], p[1] + step[1], p[2] + step[2]};
        if (q[0] < 0 || q[1] < 0 || q[2] < 0 || q[0] >= dims_[0] || q[1] >= dims_[1] ||
            q[2] >= dims_[2]) {
          continue;
        }
        const auto next = static_cast<std::size_t>((q[2] * dims_[1] + q[1]) * dims_[0] + q[0]);
        if (!solid[next] || label[next] >= 0) continue;
        label[next] = n;
        wait.push(next);
      }
    }
    ++n;
  }
  Index3 dims_;
};

template <class T>
class Field {
 public:
  Field(std::vector<T> samples, Index3 dims, const ExtractOptions& options)
      : samples_(std::move(samples)),
        dims_(dims),
        options_(options),
        flood_(solid(), dims, below()) {}

  [[nodiscard]] int n() const { return flood_.n; }
  [[nodiscard]] bool below() const { return options_.inside == Inside::below; }
  [[nodiscard]] const std::vector<T>& samples() const { return samples_; }
  /// The field with some components only.
  [[nodiscard]] std::vector<T> with(const std::set<int>& kept) const {
    std::vector<T> out = samples_;
    const auto other = static_cast<T>(below() ? options_.iso + 1 : options_.iso - 1);
    for (std::size_t s = 0; s < out.size(); ++s) {
      if (flood_.label[s] >= 0 && !kept.contains(flood_.label[s])) out[s] = other;
    }
    return out;
  }
  /// The size of one component, closed at the border for volumes.
  [[nodiscard]] double size(int component, bool area) const {
    ExtractOptions o = options_;
    o.measure = true;
    o.normals = Normals::none;
    o.selection = nullptr;
    if (!area && o.border == Border::open) o.border = Border::closed;
    const VolumeReader reader =
        owned(std::unique_ptr<SlabReader>(new MemorySlabs(with({component}), dims_, kSkewed)));
    const MeshTotals totals = collect(reader, o).totals;
    return area ? totals.area.value() : totals.volume.value();
  }

 private:
  [[nodiscard]] std::vector<bool> solid() const {
    std::vector<bool> out;
    for (const T v : samples_) {
      const bool above = below() ? !(static_cast<double>(v) < options_.iso)
                                 : static_cast<double>(v) >= options_.iso;
      out.push_back(above != below());
    }
    return out;
  }

  std::vector<T> samples_;
  Index3 dims_;
  ExtractOptions options_;
  Flood flood_;
};

/// The components that a rule keeps, by sizes found another way.
template <class T>
std::set<int> kept_by(const KeepRule& rule, const Field<T>& field) {
  std::vector<std::pair<double, int>> sizes;
  for (int c = 0; c < field.n(); ++c) {
    sizes.emplace_back(field.size(c, rule.by == KeepRule::By::area), c);
  }
  std::stable_sort(sizes.begin(), sizes.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first * (1 + 2e-6); });
  std::set<int> kept;
  for (std::size_t n = 0; n < sizes.size(); ++n) {
    const bool keeps =
        rule.by == KeepRule::By::count ? n < rule.n : sizes[n].first >= rule.min_size;
    if (keeps) kept.insert(sizes[n].second);
  }
  return kept;
}

void expect_same(const Collected& got, const Collected& want) {
  expect_same_mesh(got, want);
  ASSERT_EQ(got.totals.n_boundary_edges, want.totals.n_boundary_edges);
}

/// A vertex and its normal, to look up.
using Corner = std::array<float, 6>;
std::multiset<Corner> corners_of(const Mesh& mesh) {
  std::multiset<Corner> out;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto &p = mesh.positions[v], &n = mesh.normals[v];
    out.insert({p[0], p[1], p[2], n[0], n[1], n[2]});
  }
  return out;
}

KeepRule random_rule(std::uint64_t seed) {
  switch (seed % 4) {
    case 0:
      return {};
    case 1:
      return {.n = 1 + seed % 5};
    case 2:
      return {.by = KeepRule::By::volume, .min_size = 0.7 * static_cast<double>(seed % 11)};
    default:
      return {.by = KeepRule::By::area, .min_size = 2.5 * static_cast<double>(seed % 13)};
  }
}

ExtractOptions random_options(double iso, std::uint64_t seed) {
  ExtractOptions o{.iso = iso};
  o.inside = seed % 2 == 0 ? Inside::above : Inside::below;
  o.border = seed % 3 == 0 ? Border::open : Border::closed;
  o.precision = seed % 5 == 0 ? Precision::f64 : Precision::f32;
  o.normals = Normals::none;
  return o;
}

template <class T>
class DenseComponents : public testing::Test {};
using SampleTypes = testing::Types<std::uint8_t, std::int16_t, float, double>;
TYPED_TEST_SUITE(DenseComponents, SampleTypes);

TYPED_TEST(DenseComponents, ThatRemainAreThoseOfAFieldWithoutTheOthers) {
  const Index3 dims{19, 8, 12};
  int n_dropped = 0;
  for (std::uint64_t seed = 1; seed <= 48; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ExtractOptions o = random_options(test_iso<TypeParam>(), seed);
    const Field<TypeParam> field(random_field<TypeParam>(dims, Noise(seed % 4), seed), dims, o);
    const KeepRule rule = random_rule(seed);
    const std::set<int> kept = kept_by(rule, field);
    const VolumeReader masked =
        owned(std::unique_ptr<SlabReader>(new MemorySlabs(field.with(kept), dims, kSkewed)));
    const Collected want = collect(masked, o);
    const VolumeReader reader =
        owned(std::unique_ptr<SlabReader>(new MemorySlabs(field.samples(), dims, kSkewed)));
    for (const int threads : {1, 2, 7}) {
      How how{.threads = threads, .slab_layers = static_cast<std::int32_t>(seed % 4), .keep = rule};
      how.count_first = seed % 2 == 0;
      how.chunk_bytes = seed % 3 == 0 ? 4096 : 0;
      const Collected got = collect(reader, o, how);
      ASSERT_EQ(got.totals.components->found, static_cast<std::uint64_t>(field.n()));
      ASSERT_EQ(got.totals.components->kept, kept.size());
      expect_same(got, want);
      ASSERT_FALSE(this->HasFatalFailure());
    }
    n_dropped += field.n() - static_cast<int>(kept.size());
  }
  EXPECT_GT(n_dropped, 250);
}

TYPED_TEST(DenseComponents, KeepTheirNormals) {
  const Index3 dims{19, 8, 12};
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    ExtractOptions o{.iso = test_iso<TypeParam>()};
    o.normals = seed % 2 == 0 ? Normals::gradient : Normals::face;
    const VolumeReader reader = owned(std::unique_ptr<SlabReader>(
        new MemorySlabs(random_field<TypeParam>(dims, Noise::white, seed), dims, kSkewed)));
    const std::multiset<Corner> all = corners_of(collect(reader, o).mesh);
    const Collected got = collect(reader, o, {.threads = 2, .keep = KeepRule{.n = 3}});
    ASSERT_LT(got.mesh.positions.size(), all.size());
    ASSERT_EQ(got.mesh.normals.size(), got.mesh.positions.size());
    const std::multiset<Corner> kept = corners_of(got.mesh);
    ASSERT_TRUE(std::ranges::includes(all, kept));
  }
}

using Triangle = std::array<std::array<float, 3>, 3>;
std::multiset<Triangle> triangles_of(const Mesh& mesh) {
  std::multiset<Triangle> out;
  for (const auto& t : mesh.triangles) {
    out.insert({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
  }
  return out;
}

/// What the triangles alone tell apart is what the samples do: the same bytes remain.
TYPED_TEST(DenseComponents, AreTheSameFromTheMeshAlone) {
  const Index3 dims{19, 11, 12};
  int n_cavities = 0;
  for (std::uint64_t seed = 1; seed <= 48; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    ExtractOptions o = random_options(test_iso<TypeParam>(), seed);
    o.border = Border::closed;
    o.precision = Precision::f32;
    const VolumeReader reader = owned(std::unique_ptr<SlabReader>(
        new MemorySlabs(random_field<TypeParam>(dims, Noise(seed % 4), seed), dims, kSkewed)));
    Mesh mesh = collect(reader, o).mesh;
    const MeshComponents components = find_components(mesh);
    n_cavities += static_cast<int>(check_mesh(mesh).components - components.volumes.size());
    const KeepRule rule = random_rule(seed);
    const ComponentCounts counts = keep_components(mesh, rule);
    const Collected got = collect(reader, o, {.threads = 2, .keep = rule});
    ASSERT_EQ(counts, got.totals.components);
    expect_same_bytes(mesh.positions, got.mesh.positions);
    expect_same_bytes(mesh.triangles, got.mesh.triangles);
    ASSERT_FALSE(this->HasFatalFailure());
  }
  EXPECT_GT(n_cavities, 10);
}

/// A sparse volume and a dense one with the same samples, with a margin of background.
TEST(SparseComponents, AreThoseOfADenseCopy) {
  const Index3 dims{40, 24, 72}, origin{-16, 8, -40};
  int n_dropped = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const float background = seed % 4 < 2 ? -1.0F : 2.0F;
    const std::vector<float> samples =
        blocky_field<float>(dims, Noise(seed % 4), {background, -1, 2}, seed);
    MemoryLeaves* leaves =
        new MemoryLeaves(samples, dims, origin, background, kSkewed, MemoryLeaves::seeded(seed));
    const VolumeReader sparse = owned(std::unique_ptr<LeafReader>(leaves));
    ExtractOptions o = random_options(0.25, seed);
    o.precision = Precision::f32;
    const bool solid_background = (background > 0) == (o.inside == Inside::above);
    if (seed % 3 == 0) o.region = IndexBox{{-9, 11, -37}, {12, 27, 25}};
    if (seed % 3 == 1 && solid_background) continue;  // has no end: nothing to compare with
    o.border = o.region && seed % 2 == 0 ? Border::open : Border::closed;
    // The dense copy: the region, or all samples with a margin of background around them.
    const IndexBox box = o.region.value_or(
        IndexBox{{origin[0] - 1, origin[1] - 1, origin[2] - 1},
                 {origin[0] + dims[0], origin[1] + dims[1], origin[2] + dims[2]}});
    const Index3 size{static_cast<std::int32_t>(box.extent(0)),
                      static_cast<std::int32_t>(box.extent(1)),
                      static_cast<std::int32_t>(box.extent(2))};
    std::vector<float> copy;
    for (std::int32_t k = box.lo[2]; k <= box.hi[2]; ++k) {
      for (std::int32_t j = box.lo[1]; j <= box.hi[1]; ++j) {
        for (std::int32_t i = box.lo[0]; i <= box.hi[0]; ++i) {
          const Index3 p{i - origin[0], j - origin[1], k - origin[2]};
          const bool within = p[0] >= 0 && p[1] >= 0 && p[2] >= 0 && p[0] < dims[0] &&
                              p[1] < dims[1] && p[2] < dims[2];
          copy.push_back(
              within ? samples[static_cast<std::size_t>((p[2] * dims[1] + p[1]) * dims[0] + p[0])]
                     : background);
        }
      }
    }
    Affine map = kSkewed;
    const Vec3 at = kSkewed({static_cast<double>(box.lo[0]), static_cast<double>(box.lo[1]),
                             static_cast<double>(box.lo[2])});
    for (std::size_t a = 0; a < 3; ++a) map.m[4 * a + 3] = at[a];
    ExtractOptions dense_options = o;
    dense_options.region.reset();
    if (!o.region) dense_options.border = solid_background ? Border::solid : Border::closed;
    const VolumeReader dense = owned(std::unique_ptr<SlabReader>(new MemorySlabs(copy, size, map)));
    const KeepRule rule = random_rule(seed);
    const Collected want = collect(dense, dense_options, {.keep = rule});
    for (const int threads : {1, 2, 7}) {
      const Collected got = collect(sparse, o, {.threads = threads, .keep = rule});
      ASSERT_EQ(got.totals.components, want.totals.components);
      ASSERT_EQ(got.totals.n_triangles, want.totals.n_triangles);
      ASSERT_EQ(triangles_of(got.mesh), triangles_of(want.mesh));
    }
    n_dropped += static_cast<int>(want.totals.components->dropped());
  }
  EXPECT_GT(n_dropped, 500);
}

}  // namespace
}  // namespace mc::test
