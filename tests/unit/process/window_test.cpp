// SPDX-License-Identifier: MIT
#include "process/window.hpp"

#include <gtest/gtest.h>

#include <array>

namespace mc::process {
namespace {

/// A strip of triangles n, n + 1, n + 2 over vertices at x = 0, 1, ... with normals of -x.
MeshChunk strip(std::uint32_t n_vertices) {
  MeshChunk mesh;
  for (std::uint32_t v = 0; v < n_vertices; ++v) {
    mesh.positions.insert(mesh.positions.end(), {static_cast<float>(v), 0, 1});
    mesh.normals.insert(mesh.normals.end(), {-static_cast<float>(v), 0, 0});
  }
  for (std::uint32_t t = 0; t + 2 < n_vertices; ++t) {
    mesh.indices.insert(mesh.indices.end(), {t, t + 1, t + 2});
  }
  return mesh;
}

using Indices = Buffer<std::uint32_t>;

TEST(Window, KeepsWhatIsMarkedInOrder) {
  MeshChunk mesh = strip(6);
  MeshWindow window{mesh, {}, {1, 4}, {1, 3}};
  const std::array<std::uint8_t, 6> vertices{1, 0, 1, 1, 1, 1};
  const std::array<std::uint8_t, 4> triangles{1, 1, 1, 1};
  window.keep(vertices, triangles);
  EXPECT_EQ(mesh.positions, (Buffer<float>{0, 0, 1, 2, 0, 1, 3, 0, 1, 4, 0, 1, 5, 0, 1}));
  EXPECT_EQ(mesh.normals, (Buffer<float>{0, 0, 0, -2, 0, 0, -3, 0, 0, -4, 0, 0, -5, 0, 0}));
  EXPECT_EQ(mesh.indices, (Indices{1, 2, 3, 2, 3, 4}));  // without the two at vertex 1
  EXPECT_EQ(window.own_vertices, (IndexRange{1, 3}));
  EXPECT_EQ(window.own_triangles, (IndexRange{0, 1}));
}

TEST(Window, KeepsAllOrNothing) {
  MeshChunk mesh = strip(5);
  MeshWindow window{mesh, {}, {2, 5}, {1, 3}};
  const std::array<std::uint8_t, 5> vertices{1, 1, 1, 1, 1};
  window.keep(vertices, std::array<std::uint8_t, 3>{1, 1, 1});
  EXPECT_EQ(mesh.indices, strip(5).indices);
  EXPECT_EQ(window.own_triangles, (IndexRange{1, 3}));
  window.keep(vertices, std::array<std::uint8_t, 3>{});
  EXPECT_EQ(window.own_vertices, (IndexRange{2, 5}));
  EXPECT_EQ(window.own_triangles, (IndexRange{0, 0}));
  window.keep(std::array<std::uint8_t, 5>{}, {});
  EXPECT_EQ(window.n_vertices(), 0U);
  EXPECT_EQ(window.own_vertices, (IndexRange{0, 0}));
}

TEST(Window, IsCroppedToItsOwnPart) {
  MeshChunk mesh = strip(6);
  MeshWindow window{mesh, {}, {2, 4}, {2, 3}};
  crop_to_own(window);
  EXPECT_EQ(mesh.positions, (Buffer<float>{2, 0, 1, 3, 0, 1}));
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2}));  // 2 is the first vertex of the next window
}

TEST(Window, LosesTrianglesWithoutAllVertices) {
  MeshChunk mesh = strip(6);
  mesh.positions.resize(12);
  mesh.normals.resize(12);
  drop_incomplete_triangles(mesh, 1);
  EXPECT_EQ(mesh.indices, (Indices{0, 1, 2, 1, 2, 3}));
}

TEST(Window, HasPositionsOfEitherPrecision) {
  MeshChunk single = strip(3);
  MeshWindow window{single, {}, {}, {}};
  window.set_position(1, {0.1, 2, 3});
  EXPECT_EQ(window.position(1), (Vec3{double{0.1F}, 2, 3}));
  MeshChunk exact;
  exact.positions_f64.resize(6);
  MeshWindow wide{exact, {}, {}, {}};
  wide.set_position(1, {0.1, 2, 3});
  EXPECT_EQ(wide.position(1), (Vec3{0.1, 2, 3}));
}

}  // namespace
}  // namespace mc::process
