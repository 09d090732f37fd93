// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "base/simd_target.hpp"
#include "mc/pipe.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/random_fields.hpp"
#include "support/same_mesh.hpp"

// Memory that is bounded whatever the samples are: chunks keep within their bytes, and the mesh
// does not show how it was cut.

namespace mc::test {
namespace {

/// The collecting sink, which also looks at what its chunks hold.
class WeighingSink final : public MeshSink {
 public:
  explicit WeighingSink(Collected& out) : collecting_(out) {}
  void begin_object(const MeshObject& object) override { collecting_.begin_object(object); }
  void place(const MeshChunk& chunk, std::size_t slot) override {
    const auto bytes = [](const auto& b) { return b.capacity() * sizeof(b[0]); };
    most_ = std::max<std::uint64_t>(most_, bytes(chunk.positions) + bytes(chunk.positions_f64) +
                                               bytes(chunk.normals) + bytes(chunk.indices));
    ++n_chunks_;
    collecting_.place(chunk, slot);
  }
  void end_object(const MeshTotals& totals) override { collecting_.end_object(totals); }
  void finish() override {}
  [[nodiscard]] std::uint64_t most() const { return most_; }
  [[nodiscard]] int n_chunks() const { return n_chunks_; }

 private:
  CollectingSink collecting_;
  std::uint64_t most_ = 0;
  int n_chunks_ = 0;
};

struct Weighed {
  Collected found;
  std::uint64_t most = 0;
  int n_chunks = 0;
};

Weighed weigh(const VolumeReader& reader, const ExtractOptions& extract, std::uint64_t chunk_bytes,
              int threads, std::int32_t layers) {
  const base::ThreadLimit limit(threads);
  RunOptions options;
  options.extract = extract;
  options.slab_layers = layers;
  options.chunk_bytes = chunk_bytes;
  Weighed out;
  WeighingSink sink(out.found);
  run(reader, options, true, sink, silent_progress(), {});
  out.most = sink.most();
  out.n_chunks = sink.n_chunks();
  return out;
}

void expect_same(const Collected& got, const Collected& want) {
  expect_same_mesh(got, want);
  EXPECT_EQ(got.totals.n_boundary_edges, want.totals.n_boundary_edges);
  EXPECT_EQ(got.totals.area, want.totals.area);
  EXPECT_EQ(got.totals.volume, want.totals.volume);
  EXPECT_EQ(got.totals.bounds.lo, want.totals.bounds.lo);
  EXPECT_EQ(got.totals.bounds.hi, want.totals.bounds.hi);
}

/// Bytes that a chunk of a volume with such rows may always hold: what a row can make.
std::uint64_t row_bytes(std::int32_t n) { return 3 * 36 * (2 * std::uint64_t(n) + 64) + 600; }

struct Options {
  Border border;
  Inside inside;
  Normals normals;
  Precision precision;
  bool measure;
};
constexpr Options kOptions[] = {
    {Border::open, Inside::above, Normals::gradient, Precision::f32, true},
    {Border::closed, Inside::below, Normals::face, Precision::f64, true},
    {Border::solid, Inside::above, Normals::none, Precision::f32, false},
    {Border::open, Inside::below, Normals::none, Precision::f64, true},
};

ExtractOptions extract_options(const Options& o) {
  ExtractOptions out;
  out.iso = test_iso<float>();
  out.border = o.border;
  out.inside = o.inside;
  out.normals = o.normals;
  out.precision = o.precision;
  out.measure = o.measure;
  return out;
}

void compare(const VolumeReader& reader, std::uint64_t least) {
  for (const Options& o : kOptions) {
    const ExtractOptions extract = extract_options(o);
    const Collected want = weigh(reader, extract, ~std::uint64_t{0}, 1, 0).found;
    ASSERT_FALSE(want.mesh.triangles.empty());
    for (const int threads : {1, 2, 5}) {
      for (const std::int32_t layers : {0, 1, 3}) {
        for (const std::uint64_t bytes : {std::uint64_t{1}, least, 3 * least, 20 * least}) {
          SCOPED_TRACE(testing::Message()
                       << threads << " threads, " << layers << " layers, " << bytes << " bytes");
          const Weighed got = weigh(reader, extract, bytes, threads, layers);
          expect_same(got.found, want);
          EXPECT_LE(got.most, std::max(bytes, least));
          EXPECT_GT(got.n_chunks, bytes == 1 ? 1 : 0);
        }
      }
    }
  }
}

TEST(Room, DenseMeshDoesNotShowIt) {
  for (const Index3 dims : {Index3{9, 11, 8}, {70, 5, 6}, {3, 40, 4}}) {
    for (const Noise noise : {Noise::white, Noise::plateaus, Noise::with_nan}) {
      const auto samples = random_field<float>(dims, noise, 7);
      compare(owned(std::make_unique<MemorySlabs>(samples, dims)), row_bytes(dims[0]));
    }
  }
}

TEST(Room, DenseMeshDoesNotShowItOnAnyTarget) {
  const Index3 dims{33, 9, 5};
  const auto samples = random_field<float>(dims, Noise::white, 11);
  const VolumeReader reader = owned(std::make_unique<MemorySlabs>(samples, dims));
  for (const std::string& target : base::simd_targets()) {
    SCOPED_TRACE(target);
    ASSERT_TRUE(base::set_simd_target(target));
    compare(reader, row_bytes(dims[0]));
  }
  base::reset_simd_target();
}

TEST(Room, DenseMeshOfARegionDoesNotShowIt) {
  const Index3 dims{20, 12, 9};
  const auto samples = random_field<float>(dims, Noise::white, 5);
  const VolumeReader reader = owned(std::make_unique<MemorySlabs>(samples, dims));
  ExtractOptions extract = extract_options(kOptions[0]);
  extract.region = IndexBox{{3, 2, 1}, {15, 9, 7}};
  const Collected want = weigh(reader, extract, ~std::uint64_t{0}, 1, 0).found;
  expect_same(weigh(reader, extract, 1, 2, 2).found, want);
}

/// Of a pipeline whose chunks are all there at once, which a run need not come to.
TEST(Room, IsExpectedForAFullPipelineAndNotMuchMore) {
  constexpr std::uint64_t kMiB = 1U << 20U;
  const Index3 dims{128, 128, 64};
  const auto samples = random_field<float>(dims, Noise::white, 13);
  const VolumeReader reader = owned(std::make_unique<MemorySlabs>(samples, dims));
  RunOptions options;
  options.extract = extract_options(kOptions[0]);
  options.slab_layers = 8;
  for (const int threads : {1, 2, 5}) {
    SCOPED_TRACE(threads);
    const Weighed got = weigh(reader, options.extract, 0, threads, options.slab_layers);
    const base::ThreadLimit limit(threads);
    const std::uint64_t full = got.most * std::min<std::uint64_t>(base::pipeline_slots(), 8);
    const MemoryNeed need = memory_counted(reader, options, {});
    EXPECT_GT(full, 8 * kMiB);
    EXPECT_LE(full, need.expected);
    EXPECT_LE(need.expected, 3 * full + 16 * kMiB);
  }
}

TEST(Room, SparseMeshDoesNotShowIt) {
  const Index3 dims{40, 24, 32};
  const auto samples = random_field<float>(dims, Noise::white, 3);
  const VolumeReader reader = owned(std::make_unique<MemoryLeaves>(samples, dims, Index3{}, 0.F));
  // A block has 1536 edges and 2560 triangles at most, and is there with its larger copy.
  constexpr std::uint64_t kBlock = 3 * ((1536 + 1024 + 64) * 36 + (2560 * 3 + 16) * 4);
  for (const Options& o : kOptions) {
    if (o.border != Border::open) continue;
    const ExtractOptions extract = extract_options(o);
    const Collected want = weigh(reader, extract, ~std::uint64_t{0}, 1, 0).found;
    for (const int threads : {1, 3}) {
      for (const std::uint64_t bytes : {std::uint64_t{1}, 2 * kBlock}) {
        const Weighed got = weigh(reader, extract, bytes, threads, 0);
        expect_same(got.found, want);
        EXPECT_LE(got.most, std::max(bytes, kBlock));
        EXPECT_GT(got.n_chunks, 2);
      }
    }
  }
}

}  // namespace
}  // namespace mc::test
