// SPDX-License-Identifier: MIT
#include "mc/method.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "mc/pipe.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/random_fields.hpp"

// A method that a program adds by a row of its own: dense volumes only, without bands and boxes.
// What it makes is left to the built-in method, so that the meshes can be compared.

namespace mc::test {
namespace {

class PlainEngine final : public SlabEngine {
 public:
  explicit PlainEngine(std::unique_ptr<SlabEngine> cubes) : cubes_(std::move(cubes)) {}

  [[nodiscard]] std::int32_t n_layers() const override { return cubes_->n_layers(); }
  [[nodiscard]] std::int32_t max_layers() const override { return cubes_->max_layers(); }
  [[nodiscard]] std::pair<std::int32_t, std::int32_t> planes_for(std::int32_t l0,
                                                                 std::int32_t l1) const override {
    return cubes_->planes_for(l0, l1);
  }
  std::int32_t extract(const Slab& slab, std::int32_t l0, std::int32_t l1, std::uint64_t max_bytes,
                       MeshChunk& chunk, SurfaceTotals& totals) override {
    EXPECT_EQ(l1, l0 + 1);
    EXPECT_GE(max_bytes, least_chunk_bytes());
    return cubes_->extract(slab, l0, l1, max_bytes, chunk, totals);
  }
  void count(const Slab& slab, std::int32_t l0, std::int32_t l1, SurfaceTotals& totals) override {
    cubes_->count(slab, l0, l1, totals);
  }
  [[nodiscard]] std::uint64_t scratch_bytes() const override { return cubes_->scratch_bytes(); }
  [[nodiscard]] std::uint64_t max_mesh_bytes(std::int32_t n_layers) const override {
    return cubes_->max_mesh_bytes(n_layers);
  }
  [[nodiscard]] std::uint64_t least_chunk_bytes() const override { return 3 * max_mesh_bytes(1); }

 private:
  std::unique_ptr<SlabEngine> cubes_;
};

std::unique_ptr<SlabEngine> plain_engine(const Volume& volume, const Affine& to_world,
                                         const ExtractOptions& options) {
  return std::make_unique<PlainEngine>(cubes_method().dense(volume, to_world, options));
}

constexpr Method kPlain{"plain", plain_engine};

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
