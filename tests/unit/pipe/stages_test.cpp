// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "mc/pipe.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/mesh_stages.hpp"
#include "support/packed_bytes.hpp"
#include "support/plain_method.hpp"
#include "support/random_fields.hpp"
#include "support/source_files.hpp"

// What runs with stages say to sinks and callers, and what they refuse.

namespace mc::test {
namespace {

VolumeReader noise(const Index3& dims) {
  return owned(std::unique_ptr<SlabReader>(
      new MemorySlabs(random_field<float>(dims, Noise::white, 3), dims)));
}

struct Staged {
  explicit Staged(MeshStages stages) {
    options.extract.iso = 0.25;
    options.stages = stages;
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
std::array<const MeshStage*, sizeof...(S)> list(const S&... stages) {
  return {&stages...};
}

TEST(StagedRun, DescribeTheMeshToTheSink) {
  const Bare bare;
  const Smooth smooth(1);
  const VolumeReader reader = noise({12, 12, 12});
  for (const MeshStage* more :
       {static_cast<const MeshStage*>(&bare), static_cast<const MeshStage*>(&smooth)}) {
    const auto stages = std::to_array<const MeshStage*>({&bare, more});
    const Collected got = Staged(stages)(reader);
    EXPECT_FALSE(got.object.has_normals);
    EXPECT_TRUE(got.mesh.normals.empty());
    EXPECT_GT(got.totals.n_triangles, 0U);
  }
}

TEST(StagedRun, GiveExactCountsBeforeTheMeshWhereTheyAreKnown) {
  const VolumeReader reader = noise({12, 12, 12});
  const Smooth smooth(1);
  const Cut cut;
  const auto smoothed = list(smooth);
  const Collected known = Staged(smoothed)(reader);
  ASSERT_TRUE(known.object.n_vertices);
  EXPECT_EQ(*known.object.n_triangles, known.totals.n_triangles);
  const auto cutting = list(cut);
  Staged staged(cutting);
  const Collected unknown = staged(reader);
  EXPECT_FALSE(unknown.object.n_vertices);
  EXPECT_LT(unknown.totals.n_triangles, known.totals.n_triangles);
  staged.options.count_first = CountFirst::yes;
  EXPECT_EQ(staged(reader).object.n_vertices, unknown.totals.n_vertices);
}

TEST(StagedRun, OfSingleChunksThatMoveLeaveAreaAndVolumeUnset) {
  const VolumeReader reader = noise({12, 12, 12});
  const Bend bend;
  const Bare bare;
  const auto bending = list(bend);
  Staged staged(bending);
  staged.options.extract.measure = true;
  EXPECT_FALSE(staged(reader).totals.area);
  const auto baring = list(bare);
  staged.options.stages = baring;
  const double area = staged(reader).totals.area.value();
  staged.options.stages = {};
  EXPECT_EQ(staged(reader).totals.area, area);
}

TEST(StagedRun, ThatChangeCountsMustReachOtherLayers) {
  class Thin final : public MeshStage {
   public:
    [[nodiscard]] std::string_view name() const override { return "thin"; }
    [[nodiscard]] bool changes_counts() const override { return true; }
    void apply(MeshWindow& /*window*/) const override {}
  } const thin;
  const auto stages = list(thin);
  EXPECT_EQ(Staged(stages).refusal(noise({4, 4, 4}), ErrorKind::usage),
            "thin: changes counts, but reaches no other layer; expected a reach of at least 1");
}

TEST(StagedRun, OfAStreamIsRefusedIfStagesNeedItTwice) {
  const Folder folder;
  const std::string path = folder.file("dot.raw.gz", gzip_bytes(std::string(125, '\1')));
  SourceOptions options;
  options.dims = {5, 5, 5};
  options.type = SampleType::u8;
  options.streams = true;
  const Source source = open({path}, options);
  ASSERT_TRUE(is_stream(source.reader));
  const Smooth smooth(1);
  const auto stages = list(smooth);
  EXPECT_EQ(Staged(stages).refusal(source.reader, ErrorKind::usage),
            "a stream is read only once, but smooth needs more; copy the stream to disk first");
}

/// Sheets across the volume: as much mesh as there can be in some layers, none in most.
VolumeReader sheets() {
  const Index3 dims{160, 160, 60};
  std::vector<float> samples;
  for (std::int32_t k = 0; k < dims[2]; ++k) {
    samples.insert(samples.end(), 160 * 160, k / 2 % 10 == 4 ? 1.F : 0.F);
  }
  return owned(std::unique_ptr<SlabReader>(new MemorySlabs(samples, dims)));
}

TEST(StagedRun, AreRefusedBeforeTheWorkIfAWindowExceedsTheBudget) {
  const VolumeReader reader = sheets();
  const Smooth smooth(4);
  const Bend bend;
  const auto stages = list(bend, smooth);
  Staged staged(stages);
  const std::uint64_t least = memory_needed(reader, staged.options).least;
  const std::uint64_t least_mib = (least + (1U << 20U) - 1) >> 20U;
  staged.options.memory_bytes = (least_mib << 20U) - (2U << 20U);
  EXPECT_EQ(staged.refusal(reader, ErrorKind::limit),
            "this run with smooth needs at least " + std::to_string(least_mib) + " MiB, but only " +
                std::to_string(least_mib - 2) + " MiB are allowed");
  staged.options.memory_bytes = least_mib << 20U;
  EXPECT_GT(staged(reader).totals.n_triangles, 0U);
  EXPECT_EQ(memory_counted(reader, staged.options, {}).least, least);
  // Without stages, the same surface needs no window.
  staged.options.stages = {};
  EXPECT_LT(memory_needed(reader, staged.options).least + (4U << 20U), least);
}

TEST(StagedRun, NeedMemoryForWhatTheyHoldAndTheirScratch) {
  class Heavy final : public MeshStage {
   public:
    [[nodiscard]] std::string_view name() const override { return "heavy"; }
    [[nodiscard]] StageBytes bytes() const override { return {50U << 20U, 1000, 0}; }
    void apply(MeshWindow& /*window*/) const override {}
  } const heavy;
  const VolumeReader reader = noise({40, 40, 40});
  const auto stages = list(heavy);
  const Staged staged(stages);
  const MemoryNeed plain = memory_needed(reader, Staged({}).options);
  const MemoryNeed need = memory_needed(reader, staged.options);
  EXPECT_GE(need.least, plain.least + (50U << 20U));
  EXPECT_GT(need.expected, plain.expected + (50U << 20U));
}

TEST(StagedRun, WorkWithMethodsThatMakeOneLayerAtATime) {
  const VolumeReader reader = noise({20, 14, 11});
  const Smooth smooth(2);
  const Cut cut;
  const auto stages = list(smooth, cut);
  Staged staged(stages);
  const Collected want = staged(reader);
  staged.options.extract.method = &kPlain;
  const Collected got = staged(reader);
  EXPECT_EQ(got.mesh.positions, want.mesh.positions);
  EXPECT_EQ(got.mesh.normals, want.mesh.normals);
  EXPECT_EQ(got.mesh.triangles, want.mesh.triangles);
}

TEST(StagedRun, ThatLeaveNothingAreNamed) {
  const DropAll none;
  const auto stages = list(none);
  EXPECT_EQ(Staged(stages).refusal(noise({9, 9, 9}), ErrorKind::empty),
            "drop_all: no surface is left at this iso");
}

}  // namespace
}  // namespace mc::test
