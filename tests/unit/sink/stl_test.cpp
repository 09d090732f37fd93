// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cstring>

#include "unit/sink/sink_support.hpp"

namespace mc::test {
namespace {

SinkOptions stl(bool ascii = false) {
  return {.to = "stl", .ascii = ascii, .precision = {}, .provenance = {{"iso", "0.5"}}};
}

TEST(Stl, BinaryIsHeaderCountFacets) {
  const std::string bytes = written({}, stl(), {});
  ASSERT_EQ(bytes.size(), 84U + 4 * 50);
  std::string header = "binary STL; iso: 0.5";
  header.resize(80, ' ');
  EXPECT_EQ(bytes.substr(0, 80), header);
  EXPECT_EQ(bytes.substr(80, 4), std::string("\4\0\0\0", 4));
  const std::array<float, 12> second{0, -1, 0, 0, 0, 0, 0.1F, 0, -2, 1.5F, 0, 0};
  EXPECT_EQ(std::memcmp(bytes.data() + 84 + 50, second.data(), sizeof second), 0);
  EXPECT_EQ(bytes.substr(84 + 98, 2), std::string(2, '\0'));
}

TEST(Stl, AsciiIsTheseBytes) {
  const std::string bytes = written({}, stl(true), {});
  EXPECT_TRUE(
      bytes.starts_with("solid mc\n"
                        "facet normal 0 0 1\n"
                        " outer loop\n"
                        "  vertex 0 0 0\n"
                        "  vertex 1.5 0 0\n"
                        "  vertex 0 1 0\n"
                        " endloop\n"
                        "endfacet\n"
                        "facet normal 0 -1 0\n"))
      << bytes;
  EXPECT_TRUE(bytes.ends_with(" endloop\nendfacet\nendsolid mc\n")) << bytes;
}

TEST(Stl, EveryWayGivesTheSameBytes) {
  for (const bool ascii : {false, true}) {
    const std::string expected = written({}, stl(ascii), {});
    for (const Way& way : all_ways()) {
      EXPECT_EQ(written({}, stl(ascii), way), expected) << way.stream << way.counts << way.cut;
      EXPECT_EQ(written({.has_normals = true}, stl(ascii), way), expected);
    }
  }
}

TEST(Stl, DegenerateFacetsHaveNoNormal) {
  const TemporaryFolder folder;
  const auto sink = open_mesh_sink(folder / "a.stl", stl(true));
  MeshChunk chunk;
  chunk.positions = {1, 2, 3, 4, 5, 6};
  chunk.indices = {0, 1, 0};
  sink->begin_object({});
  sink->put(chunk);
  sink->end_object({});
  sink->finish();
  EXPECT_TRUE(read_all(folder / "a.stl").starts_with("solid mc\nfacet normal 0 0 0\n"));
}

TEST(Stl, EmptyCountsNothing) {
  const TemporaryFolder folder;
  open_mesh_sink(folder / "a.stl", {})->finish();
  std::string expected = "binary STL";
  expected.resize(80, ' ');
  EXPECT_EQ(read_all(folder / "a.stl"), expected + std::string(4, '\0'));
  open_mesh_sink(folder / "b.stl", stl(true))->finish();
  EXPECT_EQ(read_all(folder / "b.stl"), "solid mc\nendsolid mc\n");
}

TEST(Stl, RefusesMoreFacetsThanItsCountHolds) {
  const TemporaryFolder folder;
  MeshObject object;
  object.n_triangles = std::uint64_t{1} << 32;
  EXPECT_EQ(error_text([&] { open_mesh_sink(folder / "a.stl", {})->begin_object(object); },
                       ErrorKind::limit),
            folder /
                "a.stl: 4294967296 triangles, but STL holds at most 4294967295; write .ply or "
                ".obj, or one --region at a time");
}

TEST(Stl, ATriangleWithoutVertexIsAFaultOfOurs) {
  const TemporaryFolder folder;
  const auto sink = open_mesh_sink(folder / "a.stl", {});
  MeshChunk chunk;
  chunk.indices = {0, 1, 2};
  sink->begin_object({});
  sink->put(chunk);
  sink->end_object({});
  EXPECT_EQ(error_text([&] { sink->finish(); }, ErrorKind::internal),
            folder / "a.stl: a triangle names no vertex");
}

}  // namespace
}  // namespace mc::test
