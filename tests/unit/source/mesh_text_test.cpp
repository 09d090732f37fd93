// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "source/mesh/mesh_input.hpp"
#include "support/mesh_files.hpp"

// PLY, OBJ and STL: variants and faults, on files written by hand.

namespace mc {
namespace {

using Triangles = std::vector<std::array<std::uint64_t, 3>>;

Mesh parse(std::string_view text, std::string_view extension = "") {
  return source::parse_mesh(
      {.bytes = std::as_bytes(std::span(text.data(), text.size())), .place = "m", .folder = {}},
      extension);
}

Triangles triangles_of(const Mesh& mesh) {
  Triangles out;
  for (std::size_t t = 0; t < mesh.n_triangles(); ++t) out.push_back(mesh.triangle(t));
  return out;
}

std::string fault_of(std::string_view text, std::string_view extension = "") {
  try {
    parse(text, extension);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    return error.what();
  }
  return "no fault";
}

constexpr std::uint64_t kOutOfRange = std::numeric_limits<std::uint64_t>::max();

TEST(ReadPly, AnyOrderNormalsPolygonsAndOtherElements) {
  const Mesh mesh = parse(
      "ply\r\nformat ascii 1.0\r\nobj_info x\r\nelement edge 1\r\nproperty list char int8 a\r\n"
      "property float b\r\nelement vertex 4\r\nproperty uchar red\r\nproperty double nz\r\n"
      "property double z\r\nproperty list int int tags\r\nproperty float x\r\n"
      "property float ny\r\nproperty int y\r\nproperty float nx\r\nelement face 1\r\n"
      "property uchar flag\r\nproperty list uint8 uint16 vertex_indices\r\nend_header\r\n"
      "2 7 7 0.5\r\n9 1 .5 0 1e0 0 0 0\r\n9 1 .5 1 4 0.1 0 0 0\r\n9 1 .5 0 +1 0 1 0\r\n"
      "9 1 .5 0 0 0 1 0\r\n1 4 0 1 2 3\r\n");
  EXPECT_EQ(mesh.position(1), (Vec3{double{0.1F}, 0, 0.5}));
  EXPECT_EQ(mesh.normals[2], (std::array<float, 3>{0, 0, 1}));
  EXPECT_EQ(triangles_of(mesh), (Triangles{{0, 1, 2}, {0, 2, 3}}));
}

TEST(ReadPly, BothByteOrdersAreEqual) {
  const Mesh little = parse(test::tetrahedron_ply_binary(false));
  const Mesh big = parse(test::tetrahedron_ply_binary(true));
  EXPECT_EQ(little.positions_f64, test::tetrahedron().positions_f64);
  EXPECT_EQ(little.positions_f64, big.positions_f64);
  EXPECT_EQ(little.triangles, big.triangles);
}

TEST(ReadPly, PositionsAreStoredInTheFilesPrecision) {
  const Mesh single = parse(test::tetrahedron_ply_text());
  EXPECT_EQ(single.positions.size(), 4U);
  EXPECT_TRUE(single.positions_f64.empty());
  EXPECT_EQ(single.position(3), (Vec3{0, 0, 1}));
  const Mesh mixed = parse(test::tetrahedron_ply_binary(false));
  EXPECT_TRUE(mixed.positions.empty());
  EXPECT_EQ(mixed.positions_f64.size(), 4U);
}

TEST(ReadPly, EmptyMeshIsRead) {
  EXPECT_TRUE(
      parse("ply\nformat ascii 1.0\nelement vertex 0\nelement face 0\nend_header\n").n_vertices() ==
      0);
}

TEST(ReadPly, NegativeIndexIsLeftToTheCheck) {
  const Mesh mesh = parse(
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
      "nan -inf 0\n3 0 -1 7\n");
  EXPECT_EQ(triangles_of(mesh), (Triangles{{0, kOutOfRange, 7}}));
  EXPECT_TRUE(std::isnan(mesh.position(0)[0]));
}

TEST(ReadPly, NamesThePlaceOfAFault) {
  const std::string head = "ply\nformat ascii 1.0\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  EXPECT_EQ(fault_of("ply\nformat text 1.0\n"),
            "m:2: 'text': expected ascii, binary_little_endian or binary_big_endian");
  EXPECT_EQ(fault_of("ply\nelement vertex 0\nend_header\n"),
            "m:3: 'end_header': expected a line 'format' before it");
  EXPECT_EQ(fault_of(head + "element vertex -1\n"), "m:3: '-1': expected the count of an element");
  EXPECT_EQ(fault_of(head + "element vertex 1\nproperty half x\n"),
            "m:4: 'half': expected a type such as float, double, uchar or int");
  EXPECT_EQ(fault_of(head + "element vertex 2\n" + xyz + "end_header\n1 2 3\n4 x 6\n"),
            "m:9: 'x': expected the value of a property");
  EXPECT_EQ(fault_of(head + "element vertex 1\n" + xyz + "end_header\n1 2 3\n4\n"),
            "m:9: '4': expected nothing after the last element");
  EXPECT_EQ(fault_of(head + "element vertex 1\n" + xyz + "end_header\n1 2 1e999\n"),
            "m:8: '1e999': out of range: expected the value of a property");
  EXPECT_EQ(fault_of(head),
            "m:3: the file ends early: expected a line of a ply header: element, "
            "property or end_header");
}

TEST(ReadPly, CountsAreHeldAgainstTheFile) {
  EXPECT_EQ(fault_of("ply\nformat binary_little_endian 1.0\nelement vertex 4000000000000000000\n"
                     "property float x\nproperty float y\nproperty float z\nend_header\n1234"),
            "m @ byte 133: the file ends early: 4000000000000000000 elements 'vertex' of 12 bytes "
            "or more are declared, but 4 bytes are left");
  std::string cut = test::tetrahedron_ply_binary(false);
  cut.pop_back();
  EXPECT_EQ(fault_of(cut), "m @ byte 280: the file ends early: expected the value of a property");
  EXPECT_EQ(fault_of(test::tetrahedron_ply_binary(true) + "xy"),
            "m @ byte 281: 2 bytes more than the header declares");
}

TEST(ReadObj, AllFormsOfAFace) {
  const Mesh mesh = parse(
      "v 0 0 0 1\nv 1 0 0 .5 .5 .5\nv 0 1 0 # last\nvt 0 0\nvn 0 0 1\n"
      "f 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf -3/1/1 -2/-1/-1 \\\n -1/1/1\n");
  EXPECT_EQ(triangles_of(mesh), Triangles(4, {0, 1, 2}));
  EXPECT_TRUE(mesh.normals.empty());  // not every corner names one
}

TEST(ReadObj, NormalsAreAttachedWhereEachVertexHasOne) {
  const std::string head = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 0 0 1\nvn 0 1 0\n";
  const Mesh mesh = parse(head + "f 1//1 2//2 3//1\nf 2//2 4//2 3//1\n");
  ASSERT_EQ(mesh.normals.size(), 4U);
  EXPECT_EQ(mesh.normals[1], (std::array<float, 3>{0, 1, 0}));
  EXPECT_EQ(mesh.normals[2], (std::array<float, 3>{0, 0, 1}));
  EXPECT_TRUE(parse(head + "f 1//1 2//2 3//1\nf 2//1 4//2 3//1\n").normals.empty());
  EXPECT_TRUE(parse(head + "f 1//1 2//2 3//1\n").normals.empty());
}

TEST(ReadObj, PolygonsAreFannedAndBadNumbersKept) {
  EXPECT_EQ(triangles_of(parse("v 0 0 0\nf 1 2 3 4 5\nf 0 -1 -2\n")),
            (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {kOutOfRange, 0, kOutOfRange}}));
}

TEST(ReadObj, EmptyMeshIsRead) {
  EXPECT_TRUE(parse("# nothing\n").n_triangles() == 0);
  EXPECT_TRUE(parse("\xEF\xBB\xBFo nothing").n_triangles() == 0);
}

TEST(ReadObj, NamesTheLineOfAFault) {
  EXPECT_EQ(fault_of("v 0 0 0\nv 1 2\n"), "m:2: the line ends early: expected three coordinates");
  EXPECT_EQ(fault_of("v 0 0 0\n\nv 1 2,5 0\n"), "m:3: '2,5': expected three coordinates");
  EXPECT_EQ(fault_of("v 0 0 0\nf 1 1\n"),
            "m:2: the line ends early: expected a face of three vertices or more");
  EXPECT_EQ(fault_of("v 0 0 0\nf 1 1x 1\n"), "m:2: '1x': expected v, v/t, v//n or v/t/n");
  EXPECT_EQ(fault_of("v 0 0 0\nvn 0 0 1\nf 1//1 1//2 1//1\n"),
            "m:3: a face names a normal that is none of the 1 in the file");
  EXPECT_EQ(fault_of("v 0 0 0\n<html>\n"),
            "m:2: '<html>': expected a statement of an obj file, such as v, vn or f");
  EXPECT_EQ(fault_of("v 0 0 0\nf 99999999999999999999 1 1\n"),
            "m:2: '99999999999999999999': out of range: expected vertex numbers");
}

TEST(ReadStl, CornersAreWeldedByExactPosition) {
  EXPECT_EQ(parse(test::tetrahedron_stl_text()).n_vertices(), 4U);
  EXPECT_EQ(parse(test::tetrahedron_stl_binary()).n_vertices(), 4U);
  EXPECT_EQ(
      triangles_of(parse("solid\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex -0 0 0 "
                         "vertex 0 1.00000001 0 endloop endfacet\nFACET NORMAL 0 0 1 OUTER LOOP "
                         "VERTEX 0 1 0 VERTEX 1e-45 0 0 VERTEX 0 0 0 ENDLOOP ENDFACET\nendsolid")),
      (Triangles{{0, 0, 1}, {1, 2, 0}}));
}

TEST(ReadStl, SeveralSolidsAndNoneAtAll) {
  const std::string text = test::tetrahedron_stl_text();
  EXPECT_EQ(parse(text + "\n" + text).n_triangles(), 8U);
  EXPECT_TRUE(parse("solid nothing\nendsolid nothing\n").n_triangles() == 0);
  EXPECT_TRUE(parse(std::string(84, '\0')).n_triangles() == 0);
}

TEST(ReadStl, NamesThePlaceOfAFault) {
  EXPECT_EQ(fault_of("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nvertex 1 1 1\n"),
            "m:5: 'vertex': expected three coordinates");
  EXPECT_EQ(fault_of("solid a\n"), "m:2: the file ends early: expected 'facet' or 'endsolid'");
  EXPECT_EQ(fault_of("hello", ".stl"),
            "m: 5 bytes: expected 'solid' or the 84 bytes with which a binary stl begins");
  std::string cut = test::tetrahedron_stl_binary();
  cut.pop_back();
  EXPECT_EQ(fault_of(cut, ".stl"),
            "m: 283 bytes, but a binary stl of 4 triangles has 284; the file is truncated or "
            "damaged");
}

}  // namespace
}  // namespace mc
