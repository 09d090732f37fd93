// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "unit/sink/sink_support.hpp"

namespace mc::test {
namespace {

SinkOptions ply(bool ascii = false) {
  return {.to = "ply", .ascii = ascii, .precision = {}, .provenance = {{"iso", "0.5"}}};
}

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

const std::string kAsciiHeader =
    "ply\n"
    "format ascii 1.0\n"
    "comment iso: 0.5\n"
    "element vertex 4\n"
    "property float x\n"
    "property float y\n"
    "property float z\n"
    "element face 4\n"
    "property list uchar int vertex_indices\n"
    "comment " +
    std::string(36, ' ') + "\nend_header\n";

TEST(Ply, AsciiIsTheseBytes) {
  EXPECT_EQ(written({}, ply(true), {}), kAsciiHeader +
                                            "0 0 0\n"
                                            "1.5 0 0\n"
                                            "0 1 0\n"
                                            "0.1 0 -2\n"
                                            "3 0 1 2\n"
                                            "3 0 3 1\n"
                                            "3 0 2 3\n"
                                            "3 1 3 2\n");
}

TEST(Ply, BinaryIsHeaderVerticesFaces) {
  const std::string bytes = written({.has_normals = true}, ply(), {});
  const std::size_t data = bytes.find("end_header\n") + 11;
  EXPECT_EQ(data % 8, 0U);
  ASSERT_EQ(bytes.size(), data + 4 * 24 + 4 * 13);
  EXPECT_EQ(at<float>(bytes, data + 24), 1.5F);           // x of vertex 1
  EXPECT_EQ(at<float>(bytes, data + 3 * 24 + 20), -1.F);  // nz of vertex 3
  const std::size_t face = data + 4 * 24 + 3 * 13;        // the last
  EXPECT_EQ(bytes[face], '\3');
  EXPECT_EQ(at<std::uint32_t>(bytes, face + 1), 1U);
  EXPECT_EQ(at<std::uint32_t>(bytes, face + 5), 3U);
  EXPECT_EQ(at<std::uint32_t>(bytes, face + 9), 2U);
}

TEST(Ply, DoublesAreWrittenAsDoubles) {
  const Tetrahedron mesh{.has_normals = true, .precision = Precision::f64};
  const std::string bytes = written(mesh, ply(), {});
  const std::size_t data = bytes.find("end_header\n") + 11;
  EXPECT_NE(bytes.find("property double x\n"), std::string::npos);
  EXPECT_NE(bytes.find("property float nx\n"), std::string::npos);
  ASSERT_EQ(bytes.size(), data + 4 * 36 + 4 * 13);
  EXPECT_EQ(at<double>(bytes, data + 3 * 36), 0.1);
  const std::string text = written(mesh, ply(true), {});
  EXPECT_NE(text.find("\n0.1 0 -2 0 0 -1\n"), std::string::npos);
}

TEST(Ply, MaterialsAreTheLastPropertyOfAVertex) {
  const Tetrahedron mesh{.has_normals = true, .precision = Precision::f64, .has_materials = true};
  const std::string text = written(mesh, ply(true), {});
  EXPECT_NE(text.find("property float nz\nproperty ushort material\nelement face"),
            std::string::npos);
  EXPECT_NE(text.find("\n0.1 0 -2 0 0 -1 65535\n"), std::string::npos);
  const std::string bytes = written(mesh, ply(), {});
  const std::size_t data = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size(), data + 4 * 38 + 4 * 13);
  EXPECT_EQ(at<std::uint16_t>(bytes, data + 38 + 36), 7);
  const std::string bare = written({.has_materials = true}, ply(), {});
  EXPECT_EQ(at<std::uint16_t>(bare, bare.find("end_header\n") + 11 + 2 * 14 + 12), 8);
}

TEST(Ply, AttributesAreProperties) {
  const Tetrahedron mesh{.has_materials = true,
                         .attributes = {{"heat"},
                                        {"flow", SampleType::f16, 3},
                                        {"mark", SampleType::i8},
                                        {"rank", SampleType::u32, 2}}};
  const std::string text = written(mesh, ply(true), {});
  EXPECT_NE(text.find("property ushort material\nproperty float heat\nproperty float flow_x\n"
                      "property float flow_y\nproperty float flow_z\nproperty char mark\n"
                      "property uint rank_x\nproperty uint rank_y\nelement face 4\n"),
            std::string::npos);
  EXPECT_NE(text.find("\n1.5 0 0 7 1 1 1.5 2 1 1 2\n0 1 0 8 2 2 2.5 3 2 2 3\n"), std::string::npos);
  const std::string bytes = written(mesh, ply(), {});
  const std::size_t data = bytes.find("end_header\n") + 11;
  constexpr std::size_t kVertex = 12 + 2 + 4 + 12 + 1 + 8;
  ASSERT_EQ(bytes.size(), data + 4 * kVertex + 4 * 13);
  EXPECT_EQ(at<std::uint16_t>(bytes, data + kVertex + 12), 7);
  EXPECT_EQ(at<float>(bytes, data + kVertex + 14), 1.F);
  EXPECT_EQ(at<float>(bytes, data + kVertex + 22), 1.5F);
  EXPECT_EQ(at<std::int8_t>(bytes, data + 3 * kVertex + 30), 3);
  EXPECT_EQ(at<std::uint32_t>(bytes, data + 3 * kVertex + 35), 4U);
  for (const Way& way : all_ways()) EXPECT_EQ(written(mesh, ply(), way), bytes);
}

TEST(Ply, HoldsAllAttributesButLongIntegers) {
  const SinkFormat& format = *find_sink_format("ply");
  EXPECT_EQ(format.attribute_bytes({"heat", SampleType::f64, 4}, {}), 32U);
  EXPECT_EQ(format.attribute_bytes({"heat", SampleType::f16, 2}, {}), 8U);
  EXPECT_EQ(format.attribute_bytes({"heat", SampleType::u8, 2}, {.ascii = true}), 10U);
  EXPECT_EQ(format.attribute_bytes({"heat", SampleType::i64}, {}), 0U);
  EXPECT_NE(error_text(
                [] {
                  written({.attributes = {{"heat", SampleType::i64}}}, ply(), {});
                },
                ErrorKind::usage)
                .find("PLY has no i64 for the attribute heat; write .glb"),
            std::string::npos);
}

TEST(Ply, EveryWayGivesTheSameBytes) {
  for (const bool ascii : {false, true}) {
    for (const bool normals : {false, true}) {
      const Tetrahedron mesh{.has_normals = normals, .has_materials = !normals};
      const std::string expected = written(mesh, ply(ascii), {});
      for (const Way& way : all_ways()) {
        EXPECT_EQ(written(mesh, ply(ascii), way), expected)
            << ascii << normals << way.stream << way.counts << way.cut;
      }
    }
  }
}

TEST(Ply, EmptyHasNoElements) {
  const TemporaryFolder folder;
  open_mesh_sink(folder / "a.ply", {})->finish();
  const std::string bytes = read_all(folder / "a.ply");
  EXPECT_NE(bytes.find("element vertex 0\n"), std::string::npos);
  EXPECT_NE(bytes.find("element face 0\n"), std::string::npos);
  EXPECT_TRUE(bytes.ends_with("\nend_header\n"));
  EXPECT_EQ(through_fifo([](const std::string& path) {
              open_mesh_sink(path, {.to = "ply", .precision = {}, .provenance = {}})->finish();
            }),
            bytes);
}

TEST(Ply, RefusesMoreVerticesThanAnIndexReaches) {
  const TemporaryFolder folder;
  MeshObject object;
  object.n_vertices = std::uint64_t{1} << 33;
  EXPECT_EQ(error_text([&] { open_mesh_sink(folder / "a.ply", {})->begin_object(object); },
                       ErrorKind::limit),
            folder /
                "a.ply: 8589934592 vertices, but PLY holds at most 4294967296; write .obj, or "
                "one --region at a time");
  EXPECT_EQ(folder.n_entries(), 0U);
}

TEST(Ply, TypesItsIndicesByTheNumberOfVertices) {
  const auto header_with = [](std::uint64_t n_vertices) {
    // A stream with known counts gets its header at once; the mesh itself never comes.
    return through_fifo([&](const std::string& path) {
      const auto sink = open_mesh_sink(path, {.to = "ply", .precision = {}, .provenance = {}});
      MeshObject object;
      object.n_vertices = n_vertices;
      object.n_triangles = 0;
      sink->begin_object(object);
      MeshChunk chunk;
      chunk.positions.resize(1 << 20);  // more than is buffered
      chunk.positions.resize(3 * (chunk.positions.size() / 3));
      sink->put(chunk);
    });
  };
  const std::uint64_t most_int = std::uint64_t{1} << 31;
  EXPECT_NE(header_with(most_int).find("list uchar int vertex_indices"), std::string::npos);
  EXPECT_NE(header_with(most_int + 1).find("list uchar uint vertex_indices"), std::string::npos);
}

TEST(Ply, HoldsOneMesh) {
  const TemporaryFolder folder;
  const auto sink = open_mesh_sink(folder / "a.ply", {});
  sink->begin_object({});
  sink->end_object({});
  EXPECT_EQ(error_text([&] { sink->begin_object({}); }, ErrorKind::usage),
            folder /
                "a.ply: PLY holds one mesh, but there are several; write .glb, .gltf or .obj, "
                "or one iso a file");
}

TEST(Ply, WrongCountsAreAFaultOfOurs) {
  const TemporaryFolder folder;
  const auto sink = open_mesh_sink(folder / "a.ply", {});
  MeshObject object;
  object.n_vertices = 1;
  object.n_triangles = 0;
  sink->begin_object(object);
  EXPECT_EQ(error_text([&] { sink->end_object({}); }, ErrorKind::internal),
            folder /
                "a.ply: the counting pass and the extraction differ: 0 vertices and 0 "
                "triangles came");
}

TEST(Ply, CommentsStayOnTheirLine) {
  SinkOptions options = ply(true);
  options.provenance = {{"grid", "a\nend_header\r"}};
  const std::string bytes = written({}, options, {});
  EXPECT_NE(bytes.find("comment grid: a end_header \n"), std::string::npos);
}

TEST(Ply, AFullDeviceIsSaid) {
  EXPECT_EQ(error_text(
                [] {
                  const auto sink = open_mesh_sink("/dev/full", ply());
                  const Tetrahedron mesh;
                  sink->begin_object(mesh.object(true));
                  sink->put(mesh.chunks(0)[0]);
                  sink->end_object(Tetrahedron::totals());
                  sink->finish();
                },
                ErrorKind::output),
            "/dev/full: cannot write: No space left on device");
}

}  // namespace
}  // namespace mc::test
