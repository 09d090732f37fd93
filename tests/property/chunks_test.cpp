// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <vector>

#include "base/parallel.hpp"
#include "mc/pipe.hpp"
#include "support/chunk_collector.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/random_edits.hpp"
#include "support/random_fields.hpp"

// Laws of a surface kept in chunks, over random edits, volumes, options, chunk sizes and threads:
// what was handed out is at any time what a new mesher makes, and all of it is the surface.

namespace mc::test {
namespace {

constexpr Index3 kDims{40, 24, 32};
constexpr Index3 kSparseOrigin{-24, -8, -16};

/// A field, dense or sparse, and what is done with it.
template <class T>
struct Trial {
  Trial(std::uint64_t its_seed, bool is_sparse)
      : seed(its_seed),
        sparse(is_sparse),
        samples(random_field<T>(kDims, sparse ? Noise::smooth : Noise(seed % 4), seed)),
        options{.extract = extract_options(), .to_world = {}, .n_cells = 8 << (seed % 3)},
        input(make_input()),
        store(input, {options.extract.inside == Inside::above, options.extract.iso, to_world()}),
        edits(seed, {middle(), 12, 5, std::is_integral_v<T> ? 6.0 : 0.5}) {}

  [[nodiscard]] Affine to_world() const {
    return seed % 2 == 0 ? Affine{} : Affine{{-1, 0.3, 0, 2, 0.1, 1.2, -0.2, 0, 0, 0.25, 0.8, -1}};
  }
  [[nodiscard]] Vec3 middle() const {
    Vec3 at;
    for (std::size_t a = 0; a < 3; ++a) {
      at[a] = kDims[a] / 2.0 + (sparse ? kSparseOrigin[a] : 0);
    }
    return to_world()(at);
  }
  [[nodiscard]] ExtractOptions extract_options() const {
    ExtractOptions o{.iso = test_iso<T>()};
    o.inside = seed % 2 == 0 ? Inside::above : Inside::below;
    o.normals = Normals((seed + 1) % 3);
    o.border = Border(seed % 4 % 3);
    if (seed % 5 == 0) o.origin = {1, 2, -3};
    if (seed % 3 == 1) {
      o.region = IndexBox{{3, 2, 4}, {37, 20, 25}};
      for (std::size_t a = 0; a < 3 && sparse; ++a) {
        o.region->lo[a] += kSparseOrigin[a];
        o.region->hi[a] += kSparseOrigin[a];
      }
    }
    return o;
  }
  [[nodiscard]] VolumeReader make_input() const {
    if (!sparse)
      return owned(std::unique_ptr<SlabReader>(new MemorySlabs(samples, kDims, to_world())));
    return owned(std::unique_ptr<LeafReader>(new MemoryLeaves(
        samples, kDims, kSparseOrigin, T{}, to_world(), MemoryLeaves::seeded(seed))));
  }

  /// One edit, or steps taken back or done again.
  void edit(int n) {
    switch (edits.whole(0, 9)) {
      case 0:
        store.undo(edits.whole(1, 2));
        break;
      case 1:
        store.redo();
        break;
      case 2:
        if (n % 4 != 0) break;
        store.apply({.op = EditOp::fill, .value = edits.chance(0.5) ? 1.0 : 0.0});
        store.apply(edits.next(EditOp::set));
        break;
      case 3:
        store.begin_group();
        store.apply(edits.next());
        store.apply(edits.next());
        store.end_group();
        break;
      default:
        store.apply(edits.next());
    }
  }

  std::uint64_t seed;
  bool sparse;
  std::vector<T> samples;
  ChunkOptions options;
  VolumeReader input;
  EditStore store;
  RandomEdits edits;
};

void expect_sums(const ChunkMesher& mesher, const ChunkCollector::Chunks& chunks) {
  ChunkSums want;
  for (const auto& [id, chunk] : chunks) {
    ++want.n_chunks;
    want.n_vertices += chunk.n_vertices;
    want.n_triangles += chunk.n_triangles;
    ASSERT_TRUE(mesher.has_surface(id));
    ASSERT_EQ(chunk.n_vertices, chunk.positions.size() / 3);
  }
  ASSERT_EQ(mesher.sums().n_chunks, want.n_chunks);
  ASSERT_EQ(mesher.sums().n_vertices, want.n_vertices);
  ASSERT_EQ(mesher.sums().n_triangles, want.n_triangles);
}

/// Follows a few edits, comparing after each.
template <class T>
void follow(std::uint64_t seed, bool sparse, int n_edits) {
  SCOPED_TRACE(testing::Message() << "seed " << seed << (sparse ? " sparse" : " dense"));
  Trial<T> trial(seed, sparse);
  ChunkMesher mesher(trial.store, trial.options);
  ChunkCollector kept;
  mesher.build(kept.take());
  for (int n = 0; n < n_edits; ++n) {
    SCOPED_TRACE(testing::Message() << "edit " << n);
    trial.edit(n);
    {
      const base::ThreadLimit threads(n % 3 + 1);
      mesher.update(trial.store.take_dirty(), kept.take());
    }
    ChunkCollector fresh;
    ChunkMesher(trial.store, trial.options).build(fresh.take());
    ASSERT_TRUE(kept.chunks() == fresh.chunks());
    ASSERT_TRUE(kept.in_order() && fresh.in_order());
    ASSERT_FALSE(kept.told_of_nothing());
    expect_sums(mesher, kept.chunks());
    const Collected whole = collect(trial.store.reader(), trial.options.extract);
    ASSERT_TRUE(welded(kept.chunks()) == welded(whole.mesh));
    ASSERT_FALSE(testing::Test::HasFatalFailure());
  }
}

template <class T>
class ChunkLaws : public testing::Test {};
using SampleTypes = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t,
                                   std::uint32_t, std::int32_t, std::int64_t, Half, float, double>;
TYPED_TEST_SUITE(ChunkLaws, SampleTypes);

TYPED_TEST(ChunkLaws, HoldForDenseVolumes) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) follow<TypeParam>(seed, false, 4);
}
TYPED_TEST(ChunkLaws, HoldForSparseVolumes) {
  for (std::uint64_t seed = 10; seed < 13; ++seed) follow<TypeParam>(seed, true, 4);
}

TEST(ChunkLawsFloat, HoldForLongScripts) {
  for (std::uint64_t seed = 20; seed < 26; ++seed) {
    follow<float>(seed, seed % 2 == 0, 24);
    if (HasFatalFailure()) return;
  }
}

// What is written out after edits is what the edited samples give as an array.
TEST(ChunkLawsFloat, AMeshOfTheStoreIsThatOfItsSamples) {
  for (std::uint64_t seed = 30; seed < 36; ++seed) {
    SCOPED_TRACE(seed);
    Trial<float> trial(seed, false);
    for (int n = 0; n < 6; ++n) trial.edit(n);
    std::vector<float> samples(trial.samples.size());
    trial.store.read_box({{0, 0, 0}, {kDims[0] - 1, kDims[1] - 1, kDims[2] - 1}},
                         std::as_writable_bytes(std::span(samples)));
    const VolumeReader plain =
        owned(std::unique_ptr<SlabReader>(new MemorySlabs(samples, kDims, trial.to_world())));
    const Collected got = collect(trial.store.reader(), trial.options.extract, {2, 3, false});
    const Collected want = collect(plain, trial.options.extract);
    ASSERT_EQ(got.mesh.positions, want.mesh.positions);
    ASSERT_EQ(got.mesh.normals, want.mesh.normals);
    ASSERT_EQ(got.mesh.triangles, want.mesh.triangles);
  }
}

}  // namespace
}  // namespace mc::test
