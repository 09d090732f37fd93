// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "unit/sink/sink_support.hpp"

namespace mc::test {
namespace {

SinkOptions obj() { return {.to = "obj", .precision = {}, .provenance = {{"iso", "0.5"}}}; }

TEST(Obj, IsTheseBytes) {
  EXPECT_EQ(written({}, obj(), {}),
            "# iso: 0.5\n"
            "o part_1\n"
            "v 0 0 0\n"
            "v 1.5 0 0\n"
            "v 0 1 0\n"
            "v 0.1 0 -2\n"
            "f 1 2 3\n"
            "f 1 4 2\n"
            "f 1 3 4\n"
            "f 2 4 3\n");
}

TEST(Obj, SeveralObjectsCountOn) {
  EXPECT_EQ(written({.has_normals = true}, obj(), {}, 2),
            "# iso: 0.5\n"
            "o part_1\n"
            "v 0 0 0\n"
            "v 1.5 0 0\n"
            "v 0 1 0\n"
            "v 0.1 0 -2\n"
            "vn 0 0 1\n"
            "vn 1 0 0\n"
            "vn 0 1 0\n"
            "vn 0 0 -1\n"
            "f 1//1 2//2 3//3\n"
            "f 1//1 4//4 2//2\n"
            "f 1//1 3//3 4//4\n"
            "f 2//2 4//4 3//3\n"
            "o part_2\n"
            "v 0 0 0\n"
            "v 1.5 0 0\n"
            "v 0 1 0\n"
            "v 0.1 0 -2\n"
            "vn 0 0 1\n"
            "vn 1 0 0\n"
            "vn 0 1 0\n"
            "vn 0 0 -1\n"
            "f 5//5 6//6 7//7\n"
            "f 5//5 8//8 6//6\n"
            "f 5//5 7//7 8//8\n"
            "f 6//6 8//8 7//7\n");
}

TEST(Obj, EveryWayGivesTheSameBytes) {
  const Tetrahedron mesh{.has_normals = true};
  const std::string expected = written(mesh, obj(), {}, 2);
  for (const Way& way : all_ways()) {
    EXPECT_EQ(written(mesh, obj(), way, 2), expected) << way.stream << way.counts << way.cut;
  }
}

TEST(Obj, PrintsDoublesInFull) {
  const TemporaryFolder folder;
  const auto sink = open_mesh_sink(folder / "a.obj", {});
  MeshObject object;
  object.precision = Precision::f64;
  MeshChunk chunk;
  chunk.positions_f64 = {1e6 + 1.0 / 3, -1e-9, 123456789.0};
  sink->begin_object(object);
  sink->put(chunk);
  sink->end_object({});
  sink->finish();
  EXPECT_EQ(read_all(folder / "a.obj"), "v 1000000.3333333334 -1e-09 123456789\n");
}

TEST(Obj, EmptyIsJustComments) {
  const TemporaryFolder folder;
  open_mesh_sink(folder / "a.obj", obj())->finish();
  EXPECT_EQ(read_all(folder / "a.obj"), "# iso: 0.5\n");
}

}  // namespace
}  // namespace mc::test
