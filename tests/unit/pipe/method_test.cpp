// SPDX-License-Identifier: MIT
#include "mc/method.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "mc/pipe.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/plain_method.hpp"
#include "support/random_fields.hpp"

// A method that a program adds by a row of its own: dense volumes only, without bands and boxes.
// What it makes is left to the built-in method, so that the meshes can be compared.

namespace mc::test {
namespace {

ExtractOptions with_plain_method() {
  ExtractOptions options{.iso = 0.25};
  options.method = &kPlain;
  return options;
}

constexpr Index3 kDims{20, 14, 11};

VolumeReader dense_noise() {
  return owned(std::unique_ptr<SlabReader>(
      new MemorySlabs(random_field<float>(kDims, Noise::white, 3), kDims)));
}

TEST(Method, OfAProgramIsUsedForDenseVolumes) {
  const VolumeReader reader = dense_noise();
  const Collected want = collect(reader, {.iso = 0.25});
  for (const std::uint64_t chunk_bytes : {0, 16}) {
    const Collected got =
        collect(reader, with_plain_method(), {.threads = 2, .chunk_bytes = chunk_bytes});
    EXPECT_EQ(got.mesh.positions, want.mesh.positions);
    EXPECT_EQ(got.mesh.normals, want.mesh.normals);
    EXPECT_EQ(got.mesh.triangles, want.mesh.triangles);
  }
}

TEST(Method, WithoutBandsNeedsMemoryForALayer) {
  const VolumeReader reader = dense_noise();
  RunOptions options;
  const MemoryNeed cubes = memory_needed(reader, options);
  options.extract.method = &kPlain;
  const MemoryNeed plain = memory_needed(reader, options);
  const std::uint64_t layer = 20 * 14 * 2 * (3 * 24 + 5 * 12);
  EXPECT_GE(plain.least, cubes.least + layer);
}

TEST(Method, ServesExtractorsToo) {
  const std::vector<float> samples = random_field<float>(kDims, Noise::white, 3);
  const View3<const float> view(samples.data(), kDims);
  const Mesh want = extract(view, {.iso = 0.25});
  const Mesh got = extract(view, with_plain_method());
  EXPECT_EQ(got.positions, want.positions);
  EXPECT_EQ(got.triangles, want.triangles);
}

std::string refusal(const auto& work) {
  try {
    work();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::usage);
    return e.what();
  }
  return "no error";
}

TEST(Method, WithoutASparseEngineRefusesSparseVolumes) {
  auto leaves = std::make_unique<MemoryLeaves>(std::vector<float>(512, 1.F), Index3{8, 8, 8},
                                               Index3{0, 0, 0}, 0.F);
  leaves->edit().name = "fog";
  const VolumeReader reader = owned(std::unique_ptr<LeafReader>(std::move(leaves)));
  EXPECT_EQ(refusal([&] { collect(reader, with_plain_method()); }),
            "fog: is sparse, and the method plain meshes dense volumes only");
}

TEST(Method, WithoutBoxesRefusesChunks) {
  const VolumeReader reader = dense_noise();
  const EditStore store(reader, {true, 0.25, {}});
  EXPECT_EQ(refusal([&] { ChunkMesher(store, {.extract = with_plain_method(), .to_world = {}}); }),
            "method: plain cannot make chunks");
}

TEST(Method, OfTheLibraryIsCubes) {
  EXPECT_EQ(cubes_method().name, "cubes");
  EXPECT_NE(cubes_method().sparse, nullptr);
  EXPECT_NE(cubes_method().box, nullptr);
}

}  // namespace
}  // namespace mc::test
