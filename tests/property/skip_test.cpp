// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>

#include "base/simd_target.hpp"
#include "support/mesh_collector.hpp"
#include "support/random_graphs.hpp"

// What is left out of procedural volumes is far from the surface, on the side that is told; what is
// there has the same bits; and so has the mesh.

namespace mc::test {
namespace {

/// A field on a lattice of its own, as a dense volume. Before it samples near the surface only, it
/// spoils all memory, so that nothing is right by chance.
class GraphSlabs final : public SlabReader {
 public:
  GraphSlabs(GraphField field, const Index3& dims, const Vec3& origin, const Vec3& spacing)
      : field_(std::move(field)), origin_(origin), spacing_(spacing) {
    volume_.type = SampleType::f32;
    volume_.lattice.box = {{0, 0, 0}, {dims[0] - 1, dims[1] - 1, dims[2] - 1}};
    volume_.lattice.to_world = Affine::scale_translate(spacing, origin);
  }
  [[nodiscard]] const Volume& volume() const override { return volume_; }
  [[nodiscard]] bool rereads_cheaply() const override { return false; }
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override {
    out.sides.clear();
    field_.sample(origin_, spacing_, {0, 0, k0}, make_room(k0, k1, out));
  }
  void read_surface(std::int32_t k0, std::int32_t k1, const SurfaceQuery& query,
                    Slab& out) const override {
    const View3<float> view = make_room(k0, k1, out);
    field_.sample_surface(origin_, spacing_, {0, 0, k0}, query, view, out.sides);
  }

 private:
  View3<float> make_room(std::int32_t k0, std::int32_t k1, Slab& out) const {
    const Index3 dims = volume_.lattice.dims();
    out.allocate(planes_of(volume_.lattice.box, k0, k1), sizeof(float));
    std::ranges::fill(out.storage, std::byte{0xFF});  // NaN
    return {reinterpret_cast<float*>(out.storage.data()), {dims[0], dims[1], k1 - k0}};
  }

  GraphField field_;
  Vec3 origin_, spacing_;
  Volume volume_;
};

/// A random field on a random lattice, and an iso and a region to look at it with.
struct Scene {
  Index3 dims{};
  std::unique_ptr<GraphSlabs> reader;
  std::vector<float> samples;
  ExtractOptions options;

  explicit Scene(std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto whole = [&](int lo, int hi) {
      return std::uniform_int_distribution<int>(lo, hi)(random);
    };
    RandomGraph source(seed, Convention::density);
    const NodeId root = source.grow(8);
    dims = {whole(2, 90), whole(2, 40), whole(2, 40)};
    const double spacing = std::exp2(whole(-6, -1));
    reader = std::make_unique<GraphSlabs>(source.graph().compile(root), dims,
                                          Vec3{-1.3, -0.7, -0.9}, Vec3{spacing, spacing, spacing});
    Slab slab;
    reader->read(0, dims[2], slab);
    samples.resize(slab.storage.size() / sizeof(float));
    std::memcpy(samples.data(), slab.storage.data(), slab.storage.size());
    const float some = samples[static_cast<std::size_t>(whole(0, int(samples.size()) - 1))];
    options.iso = std::isfinite(some) ? some : 0.25;
    options.border = static_cast<Border>(whole(0, 2));
    options.normals = static_cast<Normals>(whole(0, 2));
    options.inside = static_cast<Inside>(whole(0, 1));
    options.measure = true;
    if (whole(0, 2) == 0) {
      IndexBox region;
      for (std::size_t a = 0; a < 3; ++a) {
        region.lo[a] = whole(0, dims[a] - 2);
        region.hi[a] = whole(region.lo[a] + 1, dims[a] - 1);
      }
      options.region = region;
    }
  }
  [[nodiscard]] IndexBox region() const {
    return options.region.value_or(reader->volume().lattice.box);
  }
  [[nodiscard]] float at(const Index3& p) const {
    return samples[(static_cast<std::size_t>(p[2]) * static_cast<std::size_t>(dims[1]) +
                    static_cast<std::size_t>(p[1])) *
                       static_cast<std::size_t>(dims[0]) +
                   static_cast<std::size_t>(p[0])];
  }
};

template <class F>
void for_each(const IndexBox& box, F f) {
  for (std::int32_t k = box.lo[2]; k <= box.hi[2]; ++k) {
    for (std::int32_t j = box.lo[1]; j <= box.hi[1]; ++j) {
      for (std::int32_t i = box.lo[0]; i <= box.hi[0]; ++i) f(Index3{i, j, k});
    }
  }
}

IndexBox around(const Index3& p, const IndexBox& within) {
  IndexBox out;
  for (std::size_t a = 0; a < 3; ++a) {
    out.lo[a] = std::max(p[a] - 1, within.lo[a]);
    out.hi[a] = std::min(p[a] + 1, within.hi[a]);
  }
  return out;
}

bool bit(std::span<const std::uint64_t> words, std::int32_t n) {
  return (words[static_cast<std::size_t>(n / 64)] >> (n % 64) & 1U) != 0;
}

/// Reads planes [k0, k1) near the surface and holds them against the whole.
std::uint64_t expect_right(const Scene& scene, std::int32_t k0, std::int32_t k1) {
  const auto iso = static_cast<float>(scene.options.iso);
  IndexBox box = scene.region();
  box.lo[2] = std::max(box.lo[2], k0);
  box.hi[2] = std::min(box.hi[2], k1 - 1);
  Slab slab;
  scene.reader->read_surface(k0, k1, {scene.options.iso, scene.region(), false}, slab);
  const auto left_out = [&](const Index3& p) {
    return bit(slab.sides.known(p[1], p[2]), p[0] - box.lo[0]);
  };
  std::uint64_t n_left_out = 0;
  for_each(box, [&](const Index3& p) {
    const float right = scene.at(p);
    if (left_out(p)) {
      ++n_left_out;
      const bool above = bit(slab.sides.above(p[1], p[2]), p[0] - box.lo[0]);
      EXPECT_TRUE(above ? right >= iso : right < iso) << right << " left out, iso " << iso;
    } else {
      float found = 0;
      std::memcpy(&found,
                  slab.planes[static_cast<std::size_t>(p[2] - k0)] +
                      static_cast<std::size_t>(p[1]) * slab.row_stride_bytes +
                      static_cast<std::size_t>(p[0]) * sizeof found,
                  sizeof found);
      EXPECT_TRUE(std::bit_cast<std::uint32_t>(found) == std::bit_cast<std::uint32_t>(right) ||
                  (std::isnan(found) && std::isnan(right)))
          << found << " is not " << right;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Index3 q = p;
      ++q[axis];
      if (q[axis] > box.hi[axis] || (scene.at(p) >= iso) == (scene.at(q) >= iso)) continue;
      for (const Index3& end : {p, q}) {
        for_each(around(end, box), [&](const Index3& near) {
          EXPECT_FALSE(left_out(near)) << "next to a crossed edge";
        });
      }
    }
  });
  EXPECT_EQ(slab.sides.n_left_out(), n_left_out);
  return n_left_out;
}

TEST(Skip, LeavesOutOnlyWhatIsFarFromTheSurface) {
  std::uint64_t n_left_out = 0;
  std::uint64_t n_samples = 0;
  for (std::uint32_t seed = 0; seed < 150 && !HasFailure(); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const Scene scene(seed);
    const std::int32_t middle = (scene.region().lo[2] + scene.region().hi[2]) / 2;
    n_left_out += expect_right(scene, 0, scene.dims[2]);
    n_left_out += expect_right(scene, scene.region().lo[2], middle + 1);
    n_samples += scene.samples.size();
  }
  EXPECT_GT(n_left_out, n_samples / 4) << "who leaves nothing out is always right";
}

void expect_same(const Collected& a, const Collected& b) {
  ASSERT_EQ(a.mesh.positions.size(), b.mesh.positions.size());
  ASSERT_EQ(a.mesh.normals.size(), b.mesh.normals.size());
  ASSERT_EQ(a.mesh.triangles.size(), b.mesh.triangles.size());
  const auto same = [](const auto& u, const auto& v) {
    return u.empty() || std::memcmp(u.data(), v.data(), u.size() * sizeof u[0]) == 0;
  };
  EXPECT_TRUE(same(a.mesh.positions, b.mesh.positions));
  EXPECT_TRUE(same(a.mesh.normals, b.mesh.normals));
  EXPECT_TRUE(same(a.mesh.triangles, b.mesh.triangles));
  EXPECT_EQ(a.totals.n_boundary_edges, b.totals.n_boundary_edges);
  EXPECT_EQ(a.totals.area, b.totals.area);
  EXPECT_EQ(a.totals.volume, b.totals.volume);
}

TEST(Skip, DoesNotShowInTheMesh) {
  constexpr std::array<How, 4> kHows{{{.threads = 1},
                                      {.threads = 2, .slab_layers = 3},
                                      {.threads = 3},
                                      {.threads = 7, .slab_layers = 1}}};
  std::uint64_t n_skipped = 0;
  for (std::uint32_t seed = 1000; seed < 1200 && !HasFailure(); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Scene scene(seed);
    const ExtractOptions options = scene.options;
    const VolumeReader reader = owned(std::move(scene.reader));
    const Collected whole = collect(reader, options, {.skip = false});
    EXPECT_EQ(whole.totals.n_skipped, 0U);
    for (const How& how : kHows) {
      const Collected skipped = collect(reader, options, how);
      expect_same(skipped, whole);
      n_skipped += skipped.totals.n_skipped;
    }
  }
  EXPECT_GT(n_skipped, 0U);
}

TEST(Skip, DoesNotShowOnAnyTarget) {
  for (std::uint32_t seed = 2000; seed < 2020 && !HasFailure(); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Scene scene(seed);
    const ExtractOptions options = scene.options;
    const VolumeReader reader = owned(std::move(scene.reader));
    const Collected whole = collect(reader, options, {.skip = false});
    for (const std::string& target : base::simd_targets()) {
      SCOPED_TRACE(target);
      ASSERT_TRUE(base::set_simd_target(target));
      expect_same(collect(reader, options), whole);
    }
    base::reset_simd_target();
  }
}

}  // namespace
}  // namespace mc::test
