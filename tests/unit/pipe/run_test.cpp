// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <vector>

#include "mc/pipe.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"

namespace mc {
namespace {

/// 40^3 samples with a surface across, between every `period` planes.
VolumeReader sheets(std::int32_t period) {
  constexpr std::int32_t kSize = 40;
  std::vector<float> samples;
  for (std::int32_t k = 0; k < kSize; ++k) {
    samples.insert(samples.end(), kSize * kSize, k / period % 2 == 0 ? 0.0F : 1.0F);
  }
  return test::owned(std::make_unique<test::MemorySlabs>(samples, Index3{kSize, kSize, kSize}));
}

MeshObject announced(const VolumeReader& reader, CountFirst count_first) {
  RunOptions options;
  options.extract.iso = 0.5;
  options.slab_layers = 1;
  options.count_first = count_first;
  test::Collected out;
  test::CollectingSink sink(out);
  run(reader, options, false, sink, silent_progress(), {});
  return out.object;
}

TEST(Run, CountsFirstWhereItIsWorthIt) {
  const VolumeReader few = sheets(39);
  const VolumeReader many = sheets(1);
  EXPECT_FALSE(announced(few, CountFirst::no).n_triangles);
  EXPECT_TRUE(announced(few, CountFirst::yes).n_triangles);
  EXPECT_FALSE(announced(few, CountFirst::if_large).n_triangles);
  EXPECT_EQ(announced(many, CountFirst::if_large).n_triangles, 39U * 39U * 39U * 2U);
}

TEST(Run, NeedsMemoryForWhatTheSinkMakes) {
  const VolumeReader reader = sheets(1);
  RunOptions options;
  const std::uint64_t plain = memory_needed(reader, options);
  options.formatted = {.vertex_bytes = 4 * 24, .triangle_bytes = 4 * 12};
  EXPECT_GT(memory_needed(reader, options), plain);
}

}  // namespace
}  // namespace mc
