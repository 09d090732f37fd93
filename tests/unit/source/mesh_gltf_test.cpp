// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "source/mesh/gltf_data.hpp"
#include "source/mesh/mesh_input.hpp"
#include "support/mesh_files.hpp"

// glTF and GLB: transforms, accessors, buffers and faults.

namespace mc {
namespace {

Mesh parse(std::string_view text) {
  return source::parse_mesh(
      {.bytes = std::as_bytes(std::span(text.data(), text.size())), .place = "m", .folder = {}},
      "");
}

std::string fault_of(std::string_view text) {
  try {
    parse(text);
  } catch (const Error& error) {
    return error.what();
  }
  return "no fault";
}

/// The tetrahedron's GLB under other nodes.
std::string with_nodes(std::string_view nodes) {
  return test::glb(test::tetrahedron_gltf("", nodes), test::tetrahedron_gltf_buffer());
}

/// The tetrahedron's GLB with `from` in its JSON replaced by `to`.
std::string with(std::string_view from, std::string_view to) {
  std::string json = test::tetrahedron_gltf("");
  const std::size_t at = json.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  json.replace(at, from.size(), to);
  return test::glb(json, test::tetrahedron_gltf_buffer());
}

TEST(ReadGltf, TransformsApplyDownTheTree) {
  const Mesh mesh = parse(with_nodes(
      R"({"translation": [1e9, 0, 0.5], "children": [1]}, {"scale": [2, 3, 4], "mesh": 0})"));
  EXPECT_EQ(mesh.position(0), (Vec3{1e9, 0, 0.5}));
  EXPECT_EQ(mesh.position(1), (Vec3{1e9 + 2, 0, 0.5}));
  EXPECT_EQ(mesh.position(3), (Vec3{1e9, 0, 4.5}));
}

TEST(ReadGltf, MatrixIsColumnByColumn) {
  const Mesh mesh =
      parse(with_nodes(R"({"mesh": 0, "matrix": [0,1,0,0, -1,0,0,0, 0,0,1,0, 5,6,7,1]})"));
  EXPECT_EQ(mesh.position(1), (Vec3{5, 7, 7}));
  EXPECT_EQ(mesh.position(2), (Vec3{4, 6, 7}));
}

TEST(ReadGltf, RotationIsAQuaternion) {
  const Mesh mesh = parse(
      with_nodes(R"({"mesh": 0, "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]})"));
  EXPECT_NEAR(mesh.position(1)[0], 0, 1e-15);
  EXPECT_NEAR(mesh.position(1)[1], 1, 1e-15);
}

TEST(ReadGltf, PositionsAreDoubleOnlyWhereANodeMoves) {
  EXPECT_EQ(parse(with_nodes(R"({"mesh": 0})")).positions.size(), 4U);
  const Mesh mesh =
      parse(with_nodes(R"({"mesh": 0, "children": [1]}, {"mesh": 0, "translation": [1e9, 0, 0]})"));
  EXPECT_TRUE(mesh.positions.empty());
  ASSERT_EQ(mesh.positions_f64.size(), 8U);
  EXPECT_EQ(mesh.position(1), (Vec3{1, 0, 0}));
  EXPECT_EQ(mesh.position(5), (Vec3{1e9 + 1, 0, 0}));
}

TEST(ReadGltf, MirroringTurnsTheWinding) {
  const MeshReport r = check_mesh(parse(with_nodes(R"({"mesh": 0, "scale": [-2, 1, 1]})")));
  EXPECT_DOUBLE_EQ(r.volume, 1. / 3);
  EXPECT_FALSE(r.defective(true));
}

TEST(ReadGltf, OnlyTheSceneIsRead) {
  EXPECT_EQ(parse(with_nodes(R"({"mesh": 0}, {"mesh": 0})")).n_triangles(), 4U);
  EXPECT_EQ(parse(with_nodes(R"({"mesh": 0, "children": [1]}, {"mesh": 0})")).n_triangles(), 8U);
  EXPECT_EQ(parse(with(R"("scenes": [{"nodes": [0]}],)", "")).n_triangles(), 4U);
}

TEST(ReadGltf, PrimitivesThatShareAccessorsShareVertices) {
  const MeshReport r = check_mesh(parse(
      with(R"("indices": 1})", R"("indices": 1}, {"attributes": {"POSITION": 0}, "indices": 1})")));
  EXPECT_EQ(r.n_vertices, 4U);
  EXPECT_EQ(r.n_triangles, 8U);
  EXPECT_EQ(r.duplicate, 4U);
}

TEST(ReadGltf, EmptyMeshIsRead) {
  EXPECT_TRUE(parse(R"({"asset": {"version": "2.0"}})").n_vertices() == 0);
  EXPECT_TRUE(parse("\xEF\xBB\xBF {\"asset\": {\"version\": \"2.0\"}}").n_vertices() == 0);
}

TEST(ReadGltf, AnIndexPastItsPrimitiveIsOutOfRange) {
  const Mesh mesh = parse(with(R"("count": 4,)", R"("count": 3,)"));
  EXPECT_EQ(mesh.n_vertices(), 3U);
  EXPECT_EQ(mesh.triangle(1)[2], std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(check_mesh(mesh).out_of_range, 3U);
}

TEST(ReadGltf, Faults) {
  EXPECT_EQ(fault_of(with(R"("count": 12)", R"("count": 15)")),
            "m: /accessors/1: 15 elements do not fit into the 24 bytes of their bufferView");
  EXPECT_EQ(fault_of(with(R"("count": 12)", R"("count": 11)")),
            "m: /meshes/0/primitives/0: 11 corners: expected three for each triangle");
  EXPECT_EQ(fault_of(with(R"("count": 12)", R"("count": 18446744073709551615)")),
            "m: /accessors/1: 18446744073709551615 elements do not fit into the 24 bytes of their "
            "bufferView");
  EXPECT_EQ(fault_of(with(R"("byteOffset": 48)", R"("byteOffset": 49)")),
            "m: /bufferViews/1: reaches past the 72 bytes of its buffer");
  EXPECT_EQ(fault_of(with(R"("byteLength": 72)", R"("byteLength": 73)")),
            "m: /buffers/0: 72 bytes, but byteLength says 73");
  EXPECT_EQ(fault_of(with("5123", "5126")),
            "m: /accessors/1/componentType: 5126 is none of the types expected here");
  EXPECT_EQ(fault_of(with("\"indices\": 1", "\"indices\": 7")),
            "m: /accessors/7: is named, but there are 2");
  EXPECT_EQ(fault_of(with("\"indices\": 1", "\"mode\": 5")),
            "m: /meshes/0/primitives/0/mode: 5 is not read: expected 4 (triangles)");
  EXPECT_EQ(fault_of(with_nodes(R"({"children": [0]})")),
            "m: /nodes/0: has two parents: expected nodes to form trees");
  EXPECT_EQ(fault_of(with("\"scene\": 0,", R"("extensionsRequired": ["KHR_draco"],)")),
            "m: /extensionsRequired/0: the file cannot be read without this extension: expected "
            "plain gltf 2.0");
  EXPECT_EQ(fault_of("{\"asset\":\n{]}"), "m:2: invalid json: expected the json of a gltf");
  EXPECT_EQ(fault_of(test::tetrahedron_gltf(R"(, "uri": "a.bin")")),
            "m: /buffers/0: names a file, and a stream has none beside it");
  EXPECT_EQ(fault_of(test::tetrahedron_gltf(R"(, "uri": "/etc/a.bin")")),
            "m: /buffers/0: expected the uri of a file beside this one, or data:");
}

TEST(ReadGltf, RepetitionIsBounded) {
  std::string nodes = R"({"children": [1)";
  for (int n = 2; n < 400; ++n) {
    nodes += "," + std::to_string(n);
  }
  nodes += "]}";
  for (int n = 1; n < 400; ++n) {
    nodes += R"(,{"mesh":0})";
  }
  EXPECT_EQ(parse(with_nodes(nodes)).n_triangles(), 399U * 4);
  std::string json = test::tetrahedron_gltf("", nodes);
  const std::string primitive = R"({"attributes": {"POSITION": 0}, "indices": 1})";
  std::string many = primitive;
  for (int n = 1; n < 300; ++n) {
    many += "," + primitive;
  }
  json.replace(json.find(primitive), primitive.size(), many);
  EXPECT_EQ(fault_of(test::glb(json, test::tetrahedron_gltf_buffer())),
            "m: its nodes repeat meshes until they are more than 256 times the size of the file");
}

TEST(ReadGlb, NamesTheByteOfAFault) {
  const std::string file = with_nodes(R"({"mesh": 0})");
  EXPECT_EQ(fault_of("glTF"), "m @ byte 4: the file ends early: expected the header of a glb");
  EXPECT_EQ(fault_of("glTF" + test::bytes_of(1U) + file.substr(8)),
            "m @ byte 4: glb version 1: expected 2");
  const std::string n = std::to_string(file.size());
  EXPECT_EQ(fault_of(file + "x"), "m @ byte 8: the header says " + n + " bytes, but the file has " +
                                      std::to_string(file.size() + 1) +
                                      "; the file is truncated or damaged");
}

TEST(ReadGltf, Base64) {
  for (const std::string bytes : {"", "a", "ab", "abc", "abcd\xFF"}) {
    const auto back = source::decode_base64(test::base64(bytes));
    ASSERT_TRUE(back.has_value());
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(back->data()), back->size()), bytes);
  }
  EXPECT_FALSE(source::decode_base64("ab c").has_value());
  EXPECT_FALSE(source::decode_base64("abcde").has_value());
}

}  // namespace
}  // namespace mc
