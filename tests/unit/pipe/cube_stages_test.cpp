// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "mc/convert.hpp"
#include "mc/pipe.hpp"
#include "pipe/cube_grid.hpp"
#include "pipe/cube_store.hpp"
#include "pipe/triangle_feed.hpp"
#include "support/cube_stages.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/mesh_stages.hpp"
#include "support/packed_bytes.hpp"
#include "support/plain_method.hpp"
#include "support/random_fields.hpp"
#include "support/same_mesh.hpp"
#include "support/source_files.hpp"

// What runs with cube stages say to sinks and callers, and what they refuse.

namespace mc::test {
namespace {

VolumeReader noise(const Index3& dims) {
  return owned(std::unique_ptr<SlabReader>(
      new MemorySlabs(random_field<float>(dims, Noise::white, 3), dims)));
}

struct Cubed {
  explicit Cubed(CubeStages stages) {
    options.extract.iso = 0.25;
    options.cube_stages = stages;
  }
  Collected operator()(const VolumeReader& reader) const {
    Collected out;
    CollectingSink sink(out);
    run(reader, options, false, sink, silent_progress(), {});
    return out;
  }
  /// What the run is refused with; the sink is not touched.
  [[nodiscard]] std::string refusal(const VolumeReader& reader, ErrorKind kind) const {
    Collected out;
    CollectingSink sink(out);
    try {
      run(reader, options, false, sink, silent_progress(), {});
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), kind);
      EXPECT_EQ(out.n_objects, 0);
      return e.what();
    }
    return "no error";
  }

  RunOptions options;
};

template <class... S>
std::array<const CubeStage*, sizeof...(S)> list(const S&... stages) {
  return {&stages...};
}

TEST(CubeRun, RefusesCubesThatDoNotFit) {
  const Untouched odd(7);
  const Untouched six(6);
  const Unpeg eight(8);
  const auto one = list(odd);
  EXPECT_EQ(Cubed(one).refusal(noise({4, 4, 4}), ErrorKind::usage),
            "untouched: works on cubes of 7 cells; expected an even number of at least 2");
  const auto two = list(eight, six);
  EXPECT_EQ(Cubed(two).refusal(noise({4, 4, 4}), ErrorKind::usage),
            "untouched: works on cubes of 6 cells, but unpeg on cubes of 8");
}

TEST(CubeRun, RefusesParts) {
  const Unpeg unpeg(8);
  const auto stages = list(unpeg);
  Cubed cubed(stages);
  cubed.options.extract.part = LayerRange{0, 1};
  EXPECT_EQ(cubed.refusal(noise({4, 4, 4}), ErrorKind::usage),
            "part: layers have no mesh of their own with unpeg");
}

TEST(CubeRun, RefusesStreams) {
  const Folder folder;
  const std::string path = folder.file("dot.raw.gz", gzip_bytes(std::string(125, '\1')));
  SourceOptions options;
  options.dims = {5, 5, 5};
  options.type = SampleType::u8;
  options.streams = true;
  const Source source = open({path}, options);
  const Unpeg unpeg(8);
  const auto stages = list(unpeg);
  const Smooth smooth(1);
  const std::array<const MeshStage*, 1> windows{&smooth};
  Cubed cubed(stages);
  EXPECT_EQ(cubed.refusal(source.reader, ErrorKind::usage),
            "a stream is read only once, but unpeg needs more; copy the stream to disk first");
  cubed.options.stages = windows;
  EXPECT_EQ(
      cubed.refusal(source.reader, ErrorKind::usage),
      "a stream is read only once, but smooth, unpeg needs more; copy the stream to disk first");
}

TEST(CubeRun, RefusesABudgetBelowTheLeastBeforeTheWork) {
  const Unpeg unpeg(8);
  const auto stages = list(unpeg);
  Cubed cubed(stages);
  const VolumeReader reader = noise({90, 90, 20});
  const std::uint64_t least = memory_needed(reader, cubed.options).least;
  const std::uint64_t least_mib = (least + (1U << 20U) - 1) >> 20U;
  cubed.options.memory_bytes = (least_mib << 20U) - (2U << 20U);
  EXPECT_EQ(cubed.refusal(reader, ErrorKind::limit),
            "this run with unpeg needs at least " + std::to_string(least_mib) + " MiB, but only " +
                std::to_string(least_mib - 2) + " MiB are allowed");
  cubed.options.memory_bytes = least;
  EXPECT_GT(cubed(reader).totals.n_triangles, 0U);
  EXPECT_GT(least, memory_needed(reader, Cubed({}).options).least + (4U << 20U));
}

TEST(CubeRun, HasNoSurfaceWithoutATriangle) {
  const Unpeg unpeg(8);
  const auto stages = list(unpeg);
  Cubed cubed(stages);
  cubed.options.extract.iso = 100;
  EXPECT_EQ(cubed.refusal(noise({9, 9, 9}), ErrorKind::empty), "no surface at this iso");
}

TEST(CubeRun, WorksWithMethodsThatMakeOneLayerAtATime) {
  const VolumeReader reader = noise({20, 14, 11});
  const Unpeg unpeg(8);
  const auto stages = list(unpeg);
  Cubed cubed(stages);
  const Collected want = cubed(reader);
  cubed.options.extract.method = &kPlain;
  expect_same_mesh(cubed(reader), want);
}

TEST(CubeRun, SamplesAttributesAtTheVerticesThatAreLeft) {
  const Index3 dims{20, 14, 30};
  const VolumeReader reader = noise(dims);
  const auto attribute = volume_attribute({"value", &reader}, volume_of(reader).lattice.to_world);
  const AttributeReader* readers[] = {attribute.get()};
  const Unpeg unpeg(8);
  const auto stages = list(unpeg);
  Cubed cubed(stages);
  cubed.options.attributes = readers;
  const Collected got = cubed(reader);
  ASSERT_EQ(got.object.attributes.size(), 1U);
  ASSERT_EQ(got.mesh.attributes.size(), 1U);
  const auto values = got.mesh.attributes[0].values_as<float>();
  ASSERT_EQ(values.size(), got.mesh.n_vertices());
  ASSERT_EQ(got.totals.n_clamped.size(), 1U);
  for (const float value : values) EXPECT_NEAR(value, 0.25, 2e-2);
}

TEST(CubeRun, AddsTheDistancesOfBothPasses) {
  const Unpeg unpeg(8);
  const auto stages = list(unpeg);
  const Collected got = Cubed(stages)(noise({20, 20, 20}));
  ASSERT_TRUE(got.totals.distances);
  EXPECT_GT(got.totals.n_extracted, got.totals.n_triangles);
  EXPECT_EQ(got.totals.distances->max, 4);
  EXPECT_EQ(got.totals.distances->rms, 4);
  EXPECT_FALSE(Cubed({})(noise({9, 9, 9})).totals.distances);
}

TEST(CubeGrid, StartsAtTheLowestSampleOrAtMultiples) {
  const Affine to_world = Affine::scale_translate({2, 2, 2}, {100, 0, 0});
  const IndexBox samples{{3, 3, 3}, {19, 12, 11}};
  const pipe::CubeGrid dense(samples, to_world, {100, 0, 0}, 8, true);
  EXPECT_EQ(dense.cell(), 2);
  const auto at = [](double i, double j, double k) { return Vec3{2 * i, 2 * j, 2 * k}; };
  EXPECT_EQ(dense.cube_of(at(3, 10.9, 11), false), (Index3{0, 0, 0}));
  EXPECT_EQ(dense.cube_of(at(11, 11, 11.5), false), (Index3{1, 1, 0}));  // no cells above k = 11
  EXPECT_EQ(dense.cube_of(at(2.9, 99, -99), false), (Index3{0, 1, 0}));
  EXPECT_EQ(dense.cube_of(at(6.9, 7.1, 11), true), (Index3{0, 1, 1}));
  EXPECT_EQ(dense.cube_of(at(30, 3, 3), true), (Index3{2, 0, 0}));
  const pipe::CubeGrid sparse({}, to_world, {100, 0, 0}, 8, false);
  EXPECT_EQ(sparse.cube_of(at(-0.1, 0, 7.9), false), (Index3{-1, 0, 0}));
  EXPECT_EQ(sparse.cube_of(at(-4.1, -3.9, 4), true), (Index3{-1, 0, 1}));
  EXPECT_THROW(pipe::CubeGrid({}, Affine::scale_translate({1, 0, 1}, {}), {}, 8, false), Error);
}

TEST(TriangleFeed, ListsTrianglesInOrderOnceTheirVerticesAreThere) {
  pipe::CubeStore store;
  pipe::TriangleFeed feed;
  std::vector<pipe::CubeStore::Triangle> visited;
  const auto add = [&](std::uint64_t base, std::size_t n_vertices,
                       std::vector<std::uint32_t> indices, bool is_forward) {
    MeshChunk chunk;
    chunk.index_base = base;
    chunk.positions.resize(3 * n_vertices);
    chunk.indices.assign(indices.begin(), indices.end());
    const auto complete = feed.add(chunk, is_forward, store);
    visited.insert(visited.end(), complete.begin(), complete.end());
  };
  add(0, 3, {0, 1, 2, 1, 2, 3, 0, 2, 1}, true);
  EXPECT_EQ(visited.size(), 1U);
  EXPECT_EQ(feed.least_named(), 0U);
  add(3, 2, {0, 1, 2}, true);
  EXPECT_EQ(visited, (std::vector<pipe::CubeStore::Triangle>{{0, 1, 2}, {1, 2, 3}, {0, 2, 1}}));
  EXPECT_EQ(feed.least_named(), 3U);
  store.drop_first(3);
  feed.dropped(3);
  add(3, 1, {}, false);
  EXPECT_EQ(visited.back(), (pipe::CubeStore::Triangle{0, 1, 2}));
  EXPECT_EQ(feed.least_named(), 0U);
}

}  // namespace
}  // namespace mc::test
