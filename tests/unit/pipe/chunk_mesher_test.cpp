// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include "base/parallel.hpp"
#include "mc/pipe.hpp"
#include "support/allocations.hpp"
#include "support/chunk_collector.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"

namespace mc::test {
namespace {

/// A ball of radius `r` around the middle of n^3 samples, positive inside.
std::vector<float> ball(std::int32_t n, double r) {
  std::vector<float> samples;
  const double middle = 0.5 * (n - 1);
  for (std::int32_t k = 0; k < n; ++k) {
    for (std::int32_t j = 0; j < n; ++j) {
      for (std::int32_t i = 0; i < n; ++i) {
        samples.push_back(static_cast<float>(r - std::hypot(i - middle, j - middle, k - middle)));
      }
    }
  }
  return samples;
}

VolumeReader dense(std::int32_t n, double r) {
  return owned(std::unique_ptr<SlabReader>(new MemorySlabs(ball(n, r), Index3{n, n, n})));
}

Edit dab(EditOp op, const Vec3& at, double radius) {
  Edit edit{.op = op};
  edit.shape.center = at;
  edit.shape.radius = radius;
  return edit;
}

TEST(ChunkMesher, HandsOutWhatASurfaceHas) {
  const VolumeReader input = dense(64, 20);
  const EditStore store(input, {});
  ChunkMesher mesher(store, {.extract = {.iso = 0}, .to_world = {}, .n_cells = 32});
  ChunkCollector kept;
  mesher.build(kept.take());
  EXPECT_EQ(kept.chunks().size(), 8U);
  EXPECT_EQ(mesher.sums().n_chunks, 8U);
  for (const auto& [id, chunk] : kept.chunks()) {
    EXPECT_GT(chunk.n_boundary_edges, 0U);
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_GE(chunk.bounds[a], 32 * id[a]);
      EXPECT_LE(chunk.bounds[3 + a], 32 * id[a] + 32);
    }
  }
}

TEST(ChunkMesher, RemakesOnlyWhatADabReaches) {
  const VolumeReader input = dense(64, 20);
  EditStore store(input, {});
  ChunkMesher mesher(store, {.extract = {.iso = 0}, .to_world = {}, .n_cells = 16});
  ChunkCollector kept;
  mesher.build(kept.take());
  store.apply(dab(EditOp::add, {24, 24, 12}, 3));
  mesher.update(store.take_dirty(), kept.take());
  EXPECT_EQ(kept.n_taken(), 1U);
  mesher.update(store.take_dirty(), kept.take());
  EXPECT_EQ(kept.n_taken(), 0U);
}

// Normals look a sample further than cells.
TEST(ChunkMesher, NormalsReachOneSampleFurther) {
  const VolumeReader input = dense(64, 20);
  const EditStore store(input, {});
  const auto n_remade = [&](Normals normals, std::int32_t sample) {
    ChunkMesher mesher(store,
                       {.extract = {.iso = 0, .normals = normals}, .to_world = {}, .n_cells = 16});
    ChunkCollector kept;
    mesher.build(kept.take());
    const IndexBox dirty{{sample, 24, 24}, {sample, 24, 24}};
    mesher.update({&dirty, 1}, kept.take());
    return kept.n_taken();
  };
  EXPECT_EQ(n_remade(Normals::none, 24), 1U);
  EXPECT_EQ(n_remade(Normals::none, 16), 2U);
  EXPECT_EQ(n_remade(Normals::none, 17), 1U);
  EXPECT_EQ(n_remade(Normals::gradient, 17), 2U);
  EXPECT_EQ(n_remade(Normals::gradient, 18), 1U);
  EXPECT_EQ(n_remade(Normals::face, 15), 2U);
}

TEST(ChunkMesher, TellsOnceOfAChunkThatBecameEmpty) {
  const VolumeReader input = dense(64, 5);
  EditStore store(input, {});
  ChunkMesher mesher(store, {.extract = {.iso = 0}, .to_world = {}, .n_cells = 8});
  ChunkCollector kept;
  mesher.build(kept.take());
  ASSERT_GT(kept.chunks().size(), 0U);
  store.apply({.op = EditOp::fill, .value = -1});
  mesher.update(store.take_dirty(), kept.take());
  EXPECT_GT(kept.n_removed(), 0U);
  EXPECT_EQ(kept.chunks().size(), 0U);
  EXPECT_EQ(mesher.sums().n_chunks, 0U);
  mesher.build(kept.take());
  EXPECT_EQ(kept.n_taken(), 0U);
  store.undo();
  mesher.update(store.take_dirty(), kept.take());
  EXPECT_EQ(kept.chunks().size(), mesher.sums().n_chunks);
  EXPECT_GT(kept.chunks().size(), 0U);
}

// A closed border caps the chunks at it, and no seam between chunks.
TEST(ChunkMesher, CapsStandAtTheBorderAlone) {
  const VolumeReader input = dense(33, 40);  // solid all over
  const EditStore store(input, {});
  const ChunkOptions options{
      .extract = {.iso = 0, .border = Border::closed}, .to_world = {}, .n_cells = 8};
  ChunkMesher mesher(store, options);
  ChunkCollector kept;
  mesher.build(kept.take());
  EXPECT_EQ(kept.chunks().size(), 4 * 4 * 4 - 2 * 2 * 2U);
  EXPECT_TRUE(welded(kept.chunks()) == welded(collect(store.reader(), options.extract).mesh));
}

// Only chunks near leaves are looked at, however far apart they lie.
TEST(ChunkMesher, DoesNotFillTheBoxAroundASparseVolume) {
  const std::vector<float> samples = ball(16, 6);
  auto leaves =
      std::make_unique<MemoryLeaves>(samples, Index3{16, 16, 16}, Index3{-(1 << 28), 0, 8}, -1.F);
  const VolumeReader input = std::unique_ptr<LeafReader>(std::move(leaves));
  EditStore store(input, {});
  ChunkMesher mesher(store, {.extract = {.iso = 0}, .to_world = {}, .n_cells = 8});
  ChunkCollector kept;
  mesher.build(kept.take());
  const std::size_t n_before = kept.chunks().size();
  EXPECT_GT(n_before, 0U);
  store.apply(dab(EditOp::add, {1 << 28, 0, 0}, 3));
  const IndexBox everything{{-(1 << 29), -(1 << 29), -(1 << 29)}, {1 << 29, 1 << 29, 1 << 29}};
  mesher.update({&everything, 1}, kept.take());
  EXPECT_GT(kept.chunks().size(), n_before);
}

/// Material by position; 0 where a mesh or chunk has none.
using Painted = std::map<std::array<float, 3>, std::uint16_t>;

Painted painted(const ChunkCollector::Chunks& chunks) {
  Painted out;
  for (const auto& [id, chunk] : chunks) {
    for (std::size_t v = 0; v < chunk.n_vertices; ++v) {
      const float* p = &chunk.positions[3 * v];
      out[{p[0], p[1], p[2]}] =
          chunk.attributes.empty() ? 0 : chunk.attributes[0].values_as<std::uint16_t>()[v];
    }
  }
  return out;
}

Painted painted(const Collected& whole) {
  Painted out;
  for (std::size_t v = 0; v < whole.mesh.positions.size(); ++v) {
    out[whole.mesh.positions[v]] = whole.materials.empty() ? 0 : whole.materials[v];
  }
  return out;
}

TEST(ChunkMesher, ChunksHaveTheMaterialsOfTheWholeMesh) {
  const VolumeReader input = dense(64, 20);
  EditStore store(input, {});
  const ChunkOptions options{.extract = {.iso = 0}, .to_world = {}, .n_cells = 16};
  ChunkMesher mesher(store, options);
  ChunkCollector kept;
  mesher.build(kept.take());
  const ChunkCollector::Chunks bare = kept.chunks();
  Edit paint = dab(EditOp::paint, {32, 32, 12}, 3);
  paint.material = 7;
  store.apply(paint);
  mesher.update(store.take_dirty(), kept.take());
  EXPECT_EQ(kept.n_taken(), 4U);
  EXPECT_EQ(painted(kept.chunks()), painted(collect(store.reader(), options.extract)));
  EXPECT_FALSE(kept.chunks() == bare);
  const auto n_painted = std::ranges::count_if(
      kept.chunks(), [](const auto& chunk) { return !chunk.second.attributes.empty(); });
  EXPECT_EQ(n_painted, 4);
  store.undo();
  mesher.update(store.take_dirty(), kept.take());
  EXPECT_TRUE(kept.chunks() == bare);
}

TEST(ChunkMesher, CountsTheChunksThatABoxReaches) {
  const VolumeReader input = dense(64, 20);
  const EditStore store(input, {});
  const ChunkMesher mesher(
      store, {.extract = {.iso = 0, .normals = Normals::none}, .to_world = {}, .n_cells = 16});
  EXPECT_EQ(mesher.n_reached({{20, 20, 20}, {24, 24, 24}}), 1U);
  EXPECT_EQ(mesher.n_reached({{16, 20, 20}, {24, 24, 24}}), 2U);
  EXPECT_EQ(mesher.n_reached({{0, 0, 0}, {63, 63, 63}}), 64U);
  EXPECT_EQ(mesher.n_reached({{90, 0, 0}, {93, 3, 3}}), 0U);
  EXPECT_EQ(mesher.n_reached({}), 0U);
}

TEST(ChunkMesher, AllocatesNothingWhenWarm) {
  const base::ThreadLimit one(1);
  const VolumeReader input = dense(96, 30);
  EditStore store(input, {});
  ChunkMesher mesher(store, {.extract = {.iso = 0}, .to_world = {}, .n_cells = 32});
  std::uint64_t n_triangles = 0;
  const ChunkMesher::Take take = [&](const SurfaceChunk& c) {
    n_triangles += c.mesh.n_triangles();
  };
  mesher.build(take);
  store.apply(dab(EditOp::subtract, {48, 48, 48}, 200));  // from now on no sample is the input's
  store.apply(dab(EditOp::subtract, {48, 48, 78}, 8));
  mesher.build(take);
  const std::vector<IndexBox> dirty = store.take_dirty();
  mesher.update(dirty, take);
  n_triangles = 0;
  const std::uint64_t before = n_allocations();
  mesher.update(dirty, take);
  EXPECT_EQ(n_allocations() - before, 0U);
  EXPECT_GT(n_triangles, 0U);
}

TEST(ChunkMesher, RefusesWhatCannotBe) {
  const VolumeReader input = dense(8, 3);
  const EditStore store(input, {});
  for (const std::int32_t n : {0, 4, 12, 512, -8}) {
    EXPECT_THROW(ChunkMesher(store, {.extract = {}, .to_world = {}, .n_cells = n}), Error) << n;
  }
  EXPECT_THROW(ChunkMesher(store, {.extract = {.iso = std::nan("")}, .to_world = {}}), Error);
}

}  // namespace
}  // namespace mc::test
