// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#if MC_WITH_GLTF

#include <tiny_gltf.h>

#include <cstring>
#include <filesystem>

#include "unit/sink/sink_support.hpp"

namespace mc::test {
namespace {

SinkOptions glb() {
  return {.to = "glb", .precision = {}, .provenance = {{"iso", "0.5"}, {"frame", "ras"}}};
}

tinygltf::Model read_glb(const std::string& bytes) {
  tinygltf::Model model;
  std::string error, warning;
  EXPECT_TRUE(tinygltf::TinyGLTF().LoadBinaryFromMemory(
      &model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()),
      static_cast<unsigned>(bytes.size())))
      << error;
  EXPECT_EQ(error + warning, "");
  return model;
}

template <class T>
T at(const unsigned char* bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes + offset, sizeof value);
  return value;
}

std::uint32_t word_at(const std::string& bytes, std::size_t offset) {
  return at<std::uint32_t>(reinterpret_cast<const unsigned char*>(bytes.data()), offset);
}

/// A GLB whose one object has `n` vertices; its one triangle names the last.
std::string glb_of_n_vertices(std::size_t n, const Way& way) {
  const auto write_to = [&](const std::string& path) {
    const auto sink = open_mesh_sink(path, glb());
    MeshObject object;
    if (way.counts) {
      object.n_vertices = n;
      object.n_triangles = 1;
    }
    MeshChunk chunk;
    chunk.positions.assign(3 * n, 1.F);
    chunk.indices = {0, 1, static_cast<std::uint32_t>(n - 1)};
    sink->begin_object(object);
    sink->put(chunk);
    sink->end_object({});
    sink->finish();
  };
  if (way.stream) {
    return through_fifo(write_to);
  }
  const TemporaryFolder folder;
  write_to(folder / "a");
  return read_all(folder / "a");
}

TEST(Glb, InMemoryHasTheBytesOfTheFile) {
  MeshChunk chunk;
  chunk.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  chunk.indices = {0, 1, 2};
  for (const bool counted : {false, true}) {
    MeshObject object;
    if (counted) object.n_vertices = 3, object.n_triangles = 1;
    const auto write_to = [&](const std::string& path, const SinkOptions& options) {
      const auto sink = open_mesh_sink(path, options);
      sink->begin_object(object);
      sink->put(chunk);
      sink->end_object({});
      sink->finish();
    };
    const TemporaryFolder folder;
    write_to(folder / "a", glb());
    Buffer<std::byte> memory(99);
    SinkOptions options = glb();
    options.memory = &memory;
    write_to(folder / "none", options);
    const std::string file = read_all(folder / "a");
    EXPECT_EQ(folder.n_entries(), 1U);
    ASSERT_EQ(memory.size(), file.size());
    EXPECT_EQ(std::memcmp(memory.data(), file.data(), file.size()), 0);
  }
}

TEST(Glb, OnlyGoesIntoMemory) {
  Buffer<std::byte> memory;
  SinkOptions options;
  options.to = "ply";
  options.memory = &memory;
  EXPECT_EQ(error_text([&] { open_mesh_sink("m.ply", options); }, ErrorKind::usage),
            "m.ply: ply cannot be written to memory; write glb");
}

TEST(Glb, IsHeaderJsonBuffer) {
  const std::string bytes = written({.has_normals = true}, glb(), {});
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word_at(bytes, 4), 2U);
  EXPECT_EQ(word_at(bytes, 8), bytes.size());
  const std::size_t json = word_at(bytes, 12);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  ASSERT_EQ(json % 4, 0U);
  ASSERT_EQ(bytes.size(), 28 + json + 4 * 24 + 12 * 2);
  EXPECT_EQ(word_at(bytes, 20 + json), 4U * 24 + 12 * 2);
  EXPECT_EQ(bytes.substr(24 + json, 4), std::string("BIN\0", 4));
}

TEST(Glb, ReadsBackTheSame) {
  const tinygltf::Model model = read_glb(written({.has_normals = true}, glb(), {}));
  EXPECT_EQ(model.asset.generator, "mc");
  EXPECT_EQ(model.asset.extras.Get("frame").Get<std::string>(), "ras");
  ASSERT_EQ(model.meshes.size(), 1U);
  EXPECT_EQ(model.nodes[0].name, "part 1");
  EXPECT_FALSE(model.materials[0].doubleSided);
  const tinygltf::Primitive& primitive = model.meshes[0].primitives[0];
  const tinygltf::Accessor& position =
      model.accessors[static_cast<std::size_t>(primitive.attributes.at("POSITION"))];
  EXPECT_EQ(position.count, 4U);
  EXPECT_EQ(position.minValues, (std::vector<double>{0, 0, -2}));
  EXPECT_EQ(position.maxValues, (std::vector<double>{1.5, 1, 0}));
  const tinygltf::Accessor& normal =
      model.accessors[static_cast<std::size_t>(primitive.attributes.at("NORMAL"))];
  EXPECT_EQ(normal.byteOffset, 12U);
  const tinygltf::Accessor& index = model.accessors[static_cast<std::size_t>(primitive.indices)];
  EXPECT_EQ(index.componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
  const unsigned char* data = model.buffers[0].data.data();
  EXPECT_EQ(at<float>(data, 24), 1.5F);
  EXPECT_EQ(at<float>(data, 3 * 24 + 20), -1.F);
  EXPECT_EQ(at<std::uint16_t>(data, 96 + 2 * 10), 3U);  // 1 3 2
}

TEST(Glb, MaterialsAreIndicesAndColours) {
  const Tetrahedron mesh{.has_normals = true, .has_materials = true};
  const tinygltf::Model model = read_glb(written(mesh, glb(), {}, 2));
  ASSERT_EQ(model.materials.size(), 1U);
  EXPECT_EQ(model.materials[0].pbrMetallicRoughness.baseColorFactor,
            (std::vector<double>{1, 1, 1, 1}));
  const tinygltf::Primitive& primitive = model.meshes[1].primitives[0];
  const auto accessor = [&](const char* name) {
    return model.accessors[static_cast<std::size_t>(primitive.attributes.at(name))];
  };
  const tinygltf::Accessor index = accessor("_MATERIAL");
  EXPECT_EQ(index.componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
  EXPECT_EQ(index.byteOffset, 24U);
  EXPECT_EQ(index.count, 4U);
  const tinygltf::Accessor colour = accessor("COLOR_0");
  EXPECT_EQ(colour.byteOffset, 28U);
  EXPECT_TRUE(colour.normalized);
  const auto& view = model.bufferViews[static_cast<std::size_t>(index.bufferView)];
  EXPECT_EQ(view.byteStride, 32U);
  const unsigned char* data = model.buffers[0].data.data() + view.byteOffset;
  EXPECT_EQ(at<std::uint16_t>(data, 24), 0);
  EXPECT_EQ(at<std::uint16_t>(data, 3 * 32 + 24), 65535);
  EXPECT_EQ(at<std::uint32_t>(data, 28), 0xFF999999U);                                // 0 is grey
  EXPECT_EQ(at<std::uint32_t>(data, 2 * 32 + 28), 0xFF0058CAU);                       // 8 is orange
  EXPECT_NE(at<std::uint32_t>(data, 32 + 28), at<std::uint32_t>(data, 2 * 32 + 28));  // 7 is not
}

/// Keeps what is warned of.
class Warnings final : public Progress {
 public:
  void begin(std::string_view, std::uint64_t, std::string_view) override {}
  void advance(std::uint64_t) override {}
  void note(std::string_view) override {}
  void warn(std::string_view text) override { all.emplace_back(text); }
  std::vector<std::string> all;
};

TEST(Glb, AttributesAreAlignedAndInCapitals) {
  const Tetrahedron mesh{
      .has_normals = true,
      .has_materials = true,
      .attributes = {{"kind", SampleType::u8, 3}, {"heat"}, {"rank", SampleType::u32, 2}}};
  Warnings warnings;
  SinkOptions options = glb();
  options.progress = &warnings;
  const std::string bytes = written(mesh, options, {});
  const tinygltf::Model model = read_glb(bytes);
  const tinygltf::Primitive& primitive = model.meshes[0].primitives[0];
  EXPECT_EQ(primitive.attributes.size(), 7U);
  const auto accessor = [&](const char* name) {
    return model.accessors[static_cast<std::size_t>(primitive.attributes.at(name))];
  };
  EXPECT_EQ(accessor("_MATERIAL").byteOffset, 24U);
  const tinygltf::Accessor kind = accessor("_KIND");
  EXPECT_EQ(kind.componentType, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE);
  EXPECT_EQ(kind.type, TINYGLTF_TYPE_VEC3);
  EXPECT_EQ(kind.byteOffset, 32U);
  const tinygltf::Accessor heat = accessor("_HEAT");
  EXPECT_EQ(heat.componentType, TINYGLTF_COMPONENT_TYPE_FLOAT);
  EXPECT_EQ(heat.type, TINYGLTF_TYPE_SCALAR);
  EXPECT_EQ(heat.byteOffset, 36U);
  const tinygltf::Accessor rank = accessor("_RANK");
  EXPECT_EQ(rank.componentType, TINYGLTF_COMPONENT_TYPE_FLOAT);
  EXPECT_EQ(rank.type, TINYGLTF_TYPE_VEC2);
  const auto& view = model.bufferViews[static_cast<std::size_t>(rank.bufferView)];
  ASSERT_EQ(view.byteStride, 48U);
  const unsigned char* vertex = model.buffers[0].data.data() + view.byteOffset + 2 * 48;
  EXPECT_EQ(at<std::uint32_t>(vertex, 32), 0x00040302U);  // 2, 3, 4 and padding
  EXPECT_EQ(at<float>(vertex, 36), 2.F);
  EXPECT_EQ(at<float>(vertex, 44), 3.F);
  ASSERT_EQ(warnings.all.size(), 1U);
  EXPECT_TRUE(warnings.all[0].ends_with("glTF has no u32 for vertices, so rank is rounded to f32"));
  for (const Way& way : all_ways()) EXPECT_TRUE(written(mesh, glb(), way) == bytes);
}

TEST(Glb, NumbersThatAreNotFiniteBecomeZero) {
  Warnings warnings;
  SinkOptions options = glb();
  options.progress = &warnings;
  const TemporaryFolder folder;
  MeshObject object;
  object.attributes = {{"heat"}};
  MeshChunk chunk;
  chunk.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  chunk.indices = {0, 1, 2};
  chunk.attributes = {{object.attributes[0], Buffer<std::byte>(12)}};
  const auto heat = chunk.attributes[0].values_as<float>();
  heat[0] = std::numeric_limits<float>::quiet_NaN();
  heat[1] = 5;
  heat[2] = -std::numeric_limits<float>::infinity();
  const auto sink = open_mesh_sink(folder / "a.glb", options);
  sink->begin_object(object);
  sink->put(chunk);
  sink->end_object({});
  sink->finish();
  const tinygltf::Model model = read_glb(read_all(folder / "a.glb"));
  const unsigned char* data = model.buffers[0].data.data();
  EXPECT_EQ(at<float>(data, 12), 0.F);
  EXPECT_EQ(at<float>(data, 16 + 12), 5.F);
  EXPECT_EQ(at<float>(data, 32 + 12), 0.F);
  ASSERT_EQ(warnings.all.size(), 1U);
  EXPECT_TRUE(warnings.all[0].ends_with(
      "2 numbers of attributes are not finite, which glTF forbids: 0 instead"));
}

TEST(Glb, AVertexHas252BytesAtMost) {
  const TemporaryFolder folder;
  MeshObject object;
  for (int n = 0; n < 16; ++n) {
    object.attributes.push_back({"a" + std::to_string(n), SampleType::f32, 4});
  }
  const auto sink = open_mesh_sink(folder / "a.glb", glb());
  EXPECT_EQ(
      error_text([&] { sink->begin_object(object); }, ErrorKind::limit),
      folder / "a.glb" +
          ": 268 bytes a vertex, but glTF holds at most 252; write .ply, or fewer attributes");
}

TEST(Glb, EveryWayGivesTheSameBytes) {
  for (const std::size_t n_objects : {1U, 2U, 5U}) {
    const Tetrahedron mesh{.has_normals = n_objects == 2, .has_materials = n_objects > 1};
    const std::string expected = written(mesh, glb(), {}, n_objects);
    EXPECT_EQ(read_glb(expected).meshes.size(), n_objects);
    for (const Way& way : all_ways()) {
      EXPECT_TRUE(written(mesh, glb(), way, n_objects) == expected)
          << n_objects << way.stream << way.counts << way.cut;
    }
  }
}

TEST(Glb, IndicesAreShortWhereTheyFit) {
  for (const std::size_t n : {65535U, 65536U}) {
    const std::string bytes = glb_of_n_vertices(n, {});
    const tinygltf::Model model = read_glb(bytes);
    EXPECT_EQ(model.accessors[1].componentType, n == 65535 ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT
                                                           : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
    EXPECT_EQ(word_at(bytes, 8), bytes.size());
    EXPECT_EQ(bytes.size() % 4, 0U);  // three u16 are padded
    EXPECT_EQ(model.buffers[0].data.size(), 12 * n + (n == 65535 ? 6 : 12));
    for (const Way& way : all_ways()) {
      EXPECT_TRUE(glb_of_n_vertices(n, way) == bytes) << n << way.stream << way.counts;
    }
  }
}

TEST(Glb, AnOriginIsTheNodesTranslation) {
  const TemporaryFolder folder;
  const auto sink = open_mesh_sink(folder / "a.glb", {});
  const Tetrahedron mesh;
  MeshObject object = mesh.object(false);
  object.origin = {1e6 + 0.1, 0, -3};
  sink->begin_object(object);
  sink->put(mesh.chunks(0)[0]);
  sink->end_object(Tetrahedron::totals());
  sink->finish();
  const tinygltf::Model model = read_glb(read_all(folder / "a.glb"));
  EXPECT_EQ(model.nodes[0].translation, (std::vector<double>{1e6 + 0.1, 0, -3}));
}

TEST(Glb, EmptyIsANodeWithoutMesh) {
  const auto empty = [](bool announced) {
    return [announced](const std::string& path) {
      const auto sink = open_mesh_sink(path, glb());
      if (announced) {
        sink->begin_object({});
        sink->end_object({});
      }
      sink->finish();
    };
  };
  for (const bool announced : {false, true}) {
    const TemporaryFolder folder;
    empty(announced)(folder / "a");
    const std::string bytes = read_all(folder / "a");
    EXPECT_EQ(word_at(bytes, 8), bytes.size());
    EXPECT_EQ(word_at(bytes, 12), bytes.size() - 20);
    const tinygltf::Model model = read_glb(bytes);
    EXPECT_EQ(model.nodes.size(), 1U);
    EXPECT_EQ(model.nodes[0].mesh, -1);
    EXPECT_TRUE(model.buffers.empty());
    EXPECT_EQ(through_fifo(empty(announced)), bytes);
  }
}

TEST(Glb, NamesNeedNotBeUtf8) {
  const TemporaryFolder folder;
  const auto sink =
      open_mesh_sink(folder / "a.glb", {.to = {}, .precision = {}, .provenance = {{"g", "\xFF"}}});
  const Tetrahedron mesh;
  sink->begin_object(mesh.object(false, "\xC3\x28\""));
  sink->put(mesh.chunks(0)[0]);
  sink->end_object(Tetrahedron::totals());
  sink->finish();
  EXPECT_EQ(read_glb(read_all(folder / "a.glb")).nodes[0].name, "\xEF\xBF\xBD(\"");
}

TEST(Glb, RefusesMoreThanFourGigabytes) {
  const TemporaryFolder folder;
  const auto fault = [&](std::uint64_t n_vertices, std::uint64_t n_triangles) {
    MeshObject object;
    object.n_vertices = n_vertices;
    object.n_triangles = n_triangles;
    return error_text([&] { open_mesh_sink(folder / "a.glb", {})->begin_object(object); },
                      ErrorKind::limit);
  };
  EXPECT_EQ(fault(200'000'000, 400'000'000),
            folder /
                "a.glb: 200000000 vertices and 400000000 triangles, but a GLB holds at most "
                "4294967295 bytes; write .gltf or .ply");
  EXPECT_EQ(fault(std::uint64_t{1} << 33, 0),
            folder /
                "a.glb: 8589934592 vertices, but a glTF primitive holds at most 4294967295; "
                "write .ply, or one --region at a time");
  EXPECT_EQ(fault(70'000, ~std::uint64_t{0}).substr(0, (folder / "a.glb").size()),
            folder / "a.glb");
  EXPECT_EQ(fault(100'000'000, 200'000'000), "");
}

TEST(Gltf, IsJsonAndBuffer) {
  const TemporaryFolder folder;
  const Tetrahedron mesh{.has_normals = true};
  for (const bool counts : {false, true}) {
    const auto sink = open_mesh_sink(folder / "a b%.gltf",
                                     {.to = {}, .force = true, .precision = {}, .provenance = {}});
    sink->begin_object(mesh.object(counts));
    for (const MeshChunk& chunk : mesh.chunks(2)) {
      sink->put(chunk);
    }
    sink->end_object(Tetrahedron::totals());
    sink->finish();
    EXPECT_EQ(folder.n_entries(), 2U);
    EXPECT_EQ(read_all(folder / "a b%.bin").size(), 4U * 24 + 12 * 2);
    const std::string json = read_all(folder / "a b%.gltf");
    EXPECT_NE(json.find("\"uri\": \"a%20b%25.bin\""), std::string::npos) << json;
    EXPECT_NE(json.find("\"byteLength\": 120"), std::string::npos) << json;
  }
  const std::string glb_bytes = written(mesh, glb(), {});
  EXPECT_EQ(read_all(folder / "a b%.bin"), glb_bytes.substr(glb_bytes.size() - 120));
}

TEST(Gltf, ExistingBufferIsRefused) {
  const TemporaryFolder folder;
  write_all(folder / "a.bin", "mine");
  EXPECT_EQ(error_text([&] { open_mesh_sink(folder / "a.gltf", {}); }, ErrorKind::output),
            folder / "a.bin: exists; add --force to replace it");
  EXPECT_EQ(folder.n_entries(), 1U);
}

TEST(Gltf, EmptyHasNoBuffer) {
  const TemporaryFolder folder;
  open_mesh_sink(folder / "a.gltf", {})->finish();
  EXPECT_EQ(folder.n_entries(), 1U);
  EXPECT_EQ(read_all(folder / "a.gltf").find("buffers"), std::string::npos);
}

TEST(Gltf, IsNoStream) {
  EXPECT_EQ(
      error_text(
          [] { open_mesh_sink("/dev/null", {.to = "gltf", .precision = {}, .provenance = {}}); },
          ErrorKind::usage),
      "/dev/null: glTF is two files and cannot be written to a stream; use --to glb");
}

}  // namespace
}  // namespace mc::test

#endif
