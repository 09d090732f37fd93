// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#if MC_WITH_GLTF

#include <tiny_gltf.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>

#include "sink/gltf/gltf_sink.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/random_fields.hpp"
#include "unit/sink/sink_support.hpp"

// glTF in files of a few hundred bytes instead of 4 GiB: nothing else knows the size.

namespace mc::test {
namespace {

/// A vertex as it is stored: position and normal.
using Vertex = std::array<float, 6>;

/// What a progress was warned of.
class Warnings final : public Progress {
 public:
  void begin(std::string_view /*stage*/, std::uint64_t /*total*/,
             std::string_view /*unit*/) override {}
  void advance(std::uint64_t /*done*/) override {}
  void note(std::string_view /*text*/) override {}
  void warn(std::string_view text) override { all.emplace_back(text); }
  std::vector<std::string> all;
};

VolumeReader noise(std::uint64_t seed) {
  constexpr Index3 kDims{24, 20, 18};
  return owned(
      std::make_unique<MemorySlabs>(random_field<float>(kDims, Noise::white, seed), kDims));
}

RunOptions run_options(std::int32_t slab_layers, CountFirst count_first) {
  RunOptions options;
  options.extract.iso = test_iso<float>();
  options.extract.normals = Normals::gradient;
  options.slab_layers = slab_layers;
  options.count_first = count_first;
  options.object.name = "noise";
  return options;
}

/// Writes the fields of `seeds` as objects of one file.
void write_parts(const std::string& path, std::uint64_t most_bytes, const RunOptions& options,
                 std::span<const std::uint64_t> seeds, Progress* progress = nullptr) {
  SinkOptions sink_options;
  sink_options.force = true;
  sink_options.progress = progress;
  const auto sink = sink::open_gltf_of(path, sink_options, most_bytes);
  for (const std::uint64_t seed : seeds) {
    run(noise(seed), options, false, *sink, silent_progress(), {});
  }
  sink->finish();
}

tinygltf::Model load(const std::string& path) {
  tinygltf::Model model;
  std::string error, warning;
  EXPECT_TRUE(tinygltf::TinyGLTF().LoadASCIIFromFile(&model, &error, &warning, path)) << error;
  EXPECT_EQ(error + warning, "");
  return model;
}

const unsigned char* data_of(const tinygltf::Model& model, int accessor) {
  const auto& a = model.accessors[static_cast<std::size_t>(accessor)];
  const auto& view = model.bufferViews[static_cast<std::size_t>(a.bufferView)];
  return model.buffers[static_cast<std::size_t>(view.buffer)].data.data() + view.byteOffset +
         a.byteOffset;
}

std::uint32_t index_at(const tinygltf::Model& model, int accessor, std::size_t n) {
  const bool is_short = model.accessors[static_cast<std::size_t>(accessor)].componentType ==
                        TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
  const unsigned char* data = data_of(model, accessor);
  std::uint32_t index = 0;
  std::memcpy(&index, data + n * (is_short ? 2 : 4), is_short ? 2 : 4);
  return index;
}

/// The three vertices of every triangle, in order; checks that a primitive uses all it has.
std::vector<std::array<Vertex, 3>> triangles_of(const tinygltf::Model& model,
                                                const tinygltf::Mesh& mesh) {
  std::vector<std::array<Vertex, 3>> all;
  for (const tinygltf::Primitive& primitive : mesh.primitives) {
    const int positions = primitive.attributes.at("POSITION");
    const unsigned char* vertices = data_of(model, positions);
    std::set<std::uint32_t> used;
    const std::size_t n = model.accessors[static_cast<std::size_t>(primitive.indices)].count;
    for (std::size_t i = 0; i < n; i += 3) {
      auto& triangle = all.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t index = index_at(model, primitive.indices, i + c);
        std::memcpy(triangle[c].data(), vertices + 24 * index, sizeof(Vertex));
        used.insert(index);
      }
    }
    EXPECT_EQ(used.size(), model.accessors[static_cast<std::size_t>(positions)].count);
  }
  return all;
}

/// The same of a mesh in memory.
std::vector<std::array<Vertex, 3>> triangles_of(const Mesh& mesh) {
  std::vector<std::array<Vertex, 3>> all;
  for (const auto& ids : mesh.triangles) {
    auto& triangle = all.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& p = mesh.positions[ids[c]];
      const auto& n = mesh.normals[ids[c]];
      triangle[c] = {p[0], p[1], p[2], n[0], n[1], n[2]};
    }
  }
  return all;
}

std::map<std::string, std::string> files_in(const TemporaryFolder& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "")) {
    files[entry.path().filename().string()] = read_all(entry.path().string());
  }
  return files;
}

TEST(GltfParts, AreTheWholeMeshBitForBit) {
  const std::vector<std::uint64_t> seeds{1};
  const Mesh whole = collect(noise(1), run_options(0, CountFirst::no).extract).mesh;
  for (const std::uint64_t most : {std::uint64_t{800}, std::uint64_t{5000}, std::uint64_t{200'000},
                                   std::uint64_t{0xFFFFFFFC}}) {
    const TemporaryFolder folder;
    Warnings warnings;
    write_parts(folder / "m.gltf", most, run_options(0, CountFirst::no), seeds, &warnings);
    const tinygltf::Model model = load(folder / "m.gltf");
    ASSERT_EQ(model.meshes.size(), 1U);
    ASSERT_EQ(model.nodes.size(), 1U);
    EXPECT_EQ(model.buffers.size(), model.meshes[0].primitives.size());
    EXPECT_EQ(model.buffers.size() > 1, most < 0xFFFFFFFC);
    std::uint64_t n_vertices = 0;
    for (const tinygltf::Primitive& primitive : model.meshes[0].primitives) {
      n_vertices +=
          model.accessors[static_cast<std::size_t>(primitive.attributes.at("POSITION"))].count;
    }
    for (const tinygltf::Buffer& buffer : model.buffers) EXPECT_LE(buffer.data.size(), most);
    EXPECT_TRUE(triangles_of(model, model.meshes[0]) == triangles_of(whole)) << most;
    if (most < 0xFFFFFFFC) {
      ASSERT_EQ(warnings.all.size(), 1U);
      EXPECT_NE(warnings.all[0].find(std::to_string(n_vertices - whole.positions.size()) +
                                     " more than the mesh has"),
                std::string::npos)
          << warnings.all[0];
    } else {
      EXPECT_TRUE(warnings.all.empty());
    }
  }
}

TEST(GltfParts, AreTheSameHoweverTheMeshIsMade) {
  const std::vector<std::uint64_t> seeds{2};
  std::map<std::string, std::string> expected;
  for (const int threads : {1, 3}) {
    for (const std::int32_t layers : {0, 1, 5}) {
      for (const CountFirst count : {CountFirst::no, CountFirst::yes}) {
        const base::ThreadLimit limit(threads);
        const TemporaryFolder folder;
        write_parts(folder / "m.gltf", 10'000, run_options(layers, count), seeds);
        const auto files = files_in(folder);
        if (expected.empty()) expected = files;
        EXPECT_TRUE(files == expected) << threads << ' ' << layers;
      }
    }
  }
  EXPECT_TRUE(expected.contains("m.bin") && expected.contains("m-2.bin"));
}

TEST(GltfParts, ObjectsShareFilesAsLongAsTheyFit) {
  const std::vector<std::uint64_t> seeds{3, 4, 5};
  std::uint64_t one = 0;
  {
    const TemporaryFolder folder;
    write_parts(folder / "m.gltf", 0xFFFFFFFC, run_options(0, CountFirst::no), {seeds.data(), 1});
    one = read_all(folder / "m.bin").size();
  }
  for (const std::uint64_t most : {one / 3 / 4 * 4, one * 5 / 4 / 4 * 4, one * 5 / 2 / 4 * 4}) {
    const TemporaryFolder folder;
    write_parts(folder / "m.gltf", most, run_options(0, CountFirst::no), seeds);
    const tinygltf::Model model = load(folder / "m.gltf");
    ASSERT_EQ(model.meshes.size(), 3U);
    for (std::size_t n = 0; n < seeds.size(); ++n) {
      const Mesh whole = collect(noise(seeds[n]), run_options(0, CountFirst::no).extract).mesh;
      EXPECT_TRUE(triangles_of(model, model.meshes[n]) == triangles_of(whole)) << most << ' ' << n;
    }
    EXPECT_EQ(model.buffers.size() == 2, most > 2 * one) << most;
    for (const tinygltf::Buffer& buffer : model.buffers) EXPECT_LE(buffer.data.size(), most);
  }
}

TEST(GltfParts, LeaveNothingWhereOneIsInTheWay) {
  const TemporaryFolder folder;
  write_all(folder / "m-2.bin", "mine");
  const auto sink = sink::open_gltf_of(folder / "m.gltf", {}, 10'000);
  EXPECT_EQ(error_text(
                [&] {
                  run(noise(1), run_options(0, CountFirst::no), false, *sink, silent_progress(),
                      {});
                },
                ErrorKind::output),
            folder / "m-2.bin: exists; add --force to replace it");
  EXPECT_EQ(read_all(folder / "m-2.bin"), "mine");
  EXPECT_FALSE(std::filesystem::exists(folder / "m.bin"));
}

/// For other people's readers: writes into the folder that MC_TEST_PARTS names.
TEST(GltfParts, AreThereForReaders) {
  const char* folder = std::getenv("MC_TEST_PARTS");
  if (folder == nullptr) GTEST_SKIP() << "MC_TEST_PARTS names no folder";
  const std::vector<std::uint64_t> seeds{6, 7};
  write_parts(std::string(folder) + "/parts.gltf", 60'000, run_options(0, CountFirst::no), seeds);
}

}  // namespace
}  // namespace mc::test

#endif
