// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/parallel.hpp"
#include "mc/mesh.hpp"
#include "support/mesh_oracle.hpp"

namespace mc {
namespace {

Mesh tetrahedron() {
  Mesh mesh;
  mesh.positions_f64 = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

/// Side 2, corner v at the bits of v.
Mesh cube() {
  Mesh mesh;
  for (int v = 0; v < 8; ++v) {
    mesh.positions_f64.push_back({2. * (v & 1), 2. * (v >> 1 & 1), 2. * (v >> 2)});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// n x m quads, closed both ways round.
Mesh torus(std::uint64_t n, std::uint64_t m) {
  Mesh mesh;
  const auto id = [&](std::uint64_t i, std::uint64_t j) { return i % n * m + j % m; };
  for (std::uint64_t i = 0; i < n; ++i) {
    for (std::uint64_t j = 0; j < m; ++j) {
      const double a = 2 * M_PI * static_cast<double>(i) / static_cast<double>(n);
      const double b = 2 * M_PI * static_cast<double>(j) / static_cast<double>(m);
      const double r = 3 + std::cos(b);
      mesh.positions_f64.push_back({r * std::cos(a), r * std::sin(a), std::sin(b)});
      mesh.add_triangle({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      mesh.add_triangle({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
  return mesh;
}

void append(Mesh& mesh, const Mesh& other, std::uint64_t n_first_shared) {
  const std::uint64_t base = mesh.positions_f64.size() - n_first_shared;
  for (std::size_t v = n_first_shared; v < other.positions_f64.size(); ++v) {
    const Vec3& p = other.positions_f64[v];
    mesh.positions_f64.push_back({-p[0], -p[1], p[2] + 10});
  }
  for (const auto& t : other.triangles) {
    const auto id = [&](std::uint64_t v) { return v < n_first_shared ? v : base + v; };
    mesh.add_triangle({id(t[0]), id(t[1]), id(t[2])});
  }
}

void expect_same(const MeshReport& a, const MeshReport& b) {
  EXPECT_EQ(a.n_vertices, b.n_vertices);
  EXPECT_EQ(a.n_triangles, b.n_triangles);
  EXPECT_EQ(a.not_finite, b.not_finite);
  EXPECT_EQ(a.out_of_range, b.out_of_range);
  EXPECT_EQ(a.degenerate, b.degenerate);
  EXPECT_EQ(a.duplicate, b.duplicate);
  EXPECT_EQ(a.boundary_edges, b.boundary_edges);
  EXPECT_EQ(a.nonmanifold_edges, b.nonmanifold_edges);
  EXPECT_EQ(a.nonmanifold_vertices, b.nonmanifold_vertices);
  EXPECT_EQ(a.misoriented_edges, b.misoriented_edges);
  EXPECT_EQ(a.unreferenced_vertices, b.unreferenced_vertices);
  EXPECT_EQ(a.duplicate_vertices, b.duplicate_vertices);
  EXPECT_EQ(a.components, b.components);
  EXPECT_EQ(a.euler, b.euler);
  EXPECT_NEAR(a.area, b.area, 1e-9 * (1 + b.area));
  EXPECT_NEAR(a.volume, b.volume, 1e-9 * (1 + b.area));
  EXPECT_EQ(a.bounds.lo, b.bounds.lo);
  EXPECT_EQ(a.bounds.hi, b.bounds.hi);
}

TEST(CheckMesh, TetrahedronIsSound) {
  const MeshReport r = check_mesh(tetrahedron());
  EXPECT_TRUE(r.closed());
  EXPECT_FALSE(r.defective(true));
  EXPECT_EQ(r.euler, 2);
  EXPECT_EQ(r.components, 1U);
  EXPECT_DOUBLE_EQ(r.volume, 1. / 6);
  EXPECT_DOUBLE_EQ(r.area, 1.5 + std::sqrt(3.) / 2);
  EXPECT_EQ(r.bounds.hi, (Vec3{1, 1, 1}));
}

TEST(CheckMesh, CubeHasItsAreaAndVolume) {
  const MeshReport r = check_mesh(cube());
  EXPECT_FALSE(r.defective(true));
  EXPECT_DOUBLE_EQ(r.area, 24);
  EXPECT_DOUBLE_EQ(r.volume, 8);
  EXPECT_EQ(r.euler, 2);
}

TEST(CheckMesh, VolumeIsAccurateFarFromTheOrigin) {
  Mesh mesh = cube();
  for (Vec3& p : mesh.positions_f64) {
    for (double& x : p) {
      x += 1e12;
    }
  }
  EXPECT_DOUBLE_EQ(check_mesh(mesh).volume, 8);
}

TEST(CheckMesh, TorusHasEulerNumberZero) {
  const MeshReport r = check_mesh(torus(12, 7));
  EXPECT_FALSE(r.defective(true));
  EXPECT_EQ(r.euler, 0);
  EXPECT_EQ(r.n_triangles, 168U);
  EXPECT_GT(r.volume, 0);
}

TEST(CheckMesh, TwoTetrahedraAtOneVertexAreNotManifold) {
  Mesh mesh = tetrahedron();
  append(mesh, tetrahedron(), 1);
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.nonmanifold_vertices, 1U);
  EXPECT_EQ(r.nonmanifold_edges, 0U);
  EXPECT_EQ(r.components, 1U);
  EXPECT_EQ(r.euler, 3);
  EXPECT_TRUE(r.defective(false));
}

TEST(CheckMesh, TwoTetrahedraAtOneEdgeAreNotManifold) {
  Mesh mesh = tetrahedron();
  append(mesh, tetrahedron(), 2);
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.nonmanifold_edges, 1U);
  EXPECT_EQ(r.nonmanifold_vertices, 0U);
  EXPECT_EQ(r.boundary_edges, 0U);
  EXPECT_EQ(r.misoriented_edges, 0U);
  EXPECT_TRUE(r.defective(false));
}

TEST(CheckMesh, TwoApartAreTwoComponents) {
  Mesh mesh = tetrahedron();
  append(mesh, tetrahedron(), 0);
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.components, 2U);
  EXPECT_EQ(r.euler, 4);
  EXPECT_FALSE(r.defective(true));
}

TEST(CheckMesh, MoebiusStripHasOneEdgeOfWrongOrientation) {
  Mesh mesh;
  for (int i = 0; i < 5; ++i) {
    const double a = 2 * M_PI * i / 5;
    mesh.positions_f64.push_back({std::cos(a), std::sin(a), 0.1 * i});
  }
  for (std::uint64_t i = 0; i < 5; ++i) {
    const auto turned = [&](std::uint64_t a, std::uint64_t b) { return i % 2 == 0 ? a : b; };
    mesh.add_triangle({i, turned((i + 1) % 5, (i + 2) % 5), turned((i + 2) % 5, (i + 1) % 5)});
  }
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.euler, 0);
  EXPECT_EQ(r.boundary_edges, 5U);
  EXPECT_EQ(r.misoriented_edges, 1U);
  EXPECT_EQ(r.nonmanifold_vertices, 0U);
}

TEST(CheckMesh, FlippedTriangleIsMisorientedOnThreeEdges) {
  Mesh mesh = cube();
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.misoriented_edges, 3U);
  EXPECT_TRUE(r.closed());
  EXPECT_TRUE(r.defective(false));
}

TEST(CheckMesh, DuplicateTriangleInAnyOrder) {
  Mesh mesh = tetrahedron();
  mesh.add_triangle({3, 2, 1});
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.duplicate, 1U);
  EXPECT_EQ(r.nonmanifold_edges, 3U);
  EXPECT_TRUE(r.defective(false));
}

TEST(CheckMesh, BoundaryIsADefectOnlyWhenAskedFor) {
  Mesh mesh = tetrahedron();
  mesh.triangles.pop_back();
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.boundary_edges, 3U);
  EXPECT_FALSE(r.defective(false));
  EXPECT_TRUE(r.defective(true));
}

TEST(CheckMesh, UnreferencedAndDuplicateVerticesAreNoDefect) {
  Mesh mesh = tetrahedron();
  mesh.positions_f64.push_back({0, -0., 0});
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.unreferenced_vertices, 1U);
  EXPECT_EQ(r.duplicate_vertices, 1U);
  EXPECT_EQ(r.euler, 2);
  EXPECT_EQ(r.components, 1U);
  EXPECT_FALSE(r.defective(true));
}

TEST(CheckMesh, OutOfRangeTakesNoPartInTopology) {
  Mesh mesh = tetrahedron();
  mesh.add_triangle({0, 1, 4});
  mesh.add_triangle({0, 1, 0xFFFFFFFF});
  mesh.add_triangle({std::numeric_limits<std::uint64_t>::max(), 1, 2});
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.out_of_range, 3U);
  EXPECT_EQ(r.euler, 2);
  EXPECT_TRUE(r.closed());
  EXPECT_TRUE(r.defective(false));
}

TEST(CheckMesh, NotFiniteCountsVertices) {
  Mesh mesh = tetrahedron();
  mesh.normals.assign(4, {0, 0, 1});
  mesh.positions_f64[1][2] = std::numeric_limits<double>::quiet_NaN();
  mesh.normals[1][0] = std::numeric_limits<float>::infinity();
  mesh.normals[2][0] = std::numeric_limits<float>::infinity();
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.not_finite, 2U);
  EXPECT_DOUBLE_EQ(r.area, 0.5);  // of the one triangle without vertex 1
  EXPECT_EQ(r.bounds.hi, (Vec3{0, 1, 1}));
  EXPECT_TRUE(r.defective(false));
}

Mesh one_triangle(const Vec3& p, const Vec3& q, const Vec3& r) {
  Mesh mesh;
  mesh.positions_f64 = {p, q, r};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

TEST(CheckMesh, RepeatedVertexIsDegenerate) {
  Mesh mesh = tetrahedron();
  mesh.add_triangle({1, 1, 2});
  const MeshReport r = check_mesh(mesh);
  EXPECT_EQ(r.degenerate, 1U);
  EXPECT_EQ(r.euler, 2);
  EXPECT_TRUE(r.defective(false));
}

TEST(CheckMesh, ZeroAreaIsDecidedExactly) {
  const auto degenerate = [](const Vec3& p, const Vec3& q, const Vec3& r) {
    return check_mesh(one_triangle(p, q, r)).degenerate == 1;
  };
  EXPECT_TRUE(degenerate({0, 0, 0}, {1, 1, 1}, {2, 2, 2}));
  EXPECT_TRUE(degenerate({0, 0, 0}, {0, 0, 0}, {1, 0, 0}));
  EXPECT_FALSE(degenerate({0, 0, 0}, {1, 1, 1}, {2, 2, 2.000001}));
  // The products below agree to 53 bits and differ beyond.
  const double e = 0x1p-40;
  EXPECT_FALSE(degenerate({0, 0, 0}, {1 + e, 1, 0}, {1, 1 - e, 0}));
  EXPECT_TRUE(degenerate({0, 0, 0}, {1 + e, 1 - e, 0}, {2 + 2 * e, 2 - 2 * e, 0}));
  // Beyond the range of a double's square.
  EXPECT_FALSE(degenerate({0, 0, 0}, {1e-200, 0, 0}, {0, 1e-200, 0}));
  EXPECT_TRUE(degenerate({0, 0, 0}, {1e-200, 1e-200, 0}, {2e-200, 2e-200, 0}));
  EXPECT_FALSE(degenerate({-1e308, 0, 0}, {1e308, 0, 0}, {0, 1e308, 0}));
  EXPECT_TRUE(degenerate({-1e308, 0, 0}, {1e308, 0, 0}, {0.5e308, 0, 0}));
}

TEST(CheckMesh, EmptyIsSound) {
  const MeshReport r = check_mesh({});
  EXPECT_FALSE(r.defective(true));
  EXPECT_EQ(r.euler, 0);
  EXPECT_EQ(r.components, 0U);
  EXPECT_TRUE(r.bounds.empty());
}

TEST(CheckMesh, FiguresDoNotDependOnThreads) {
  const Mesh mesh = torus(400, 150);
  const MeshReport all = check_mesh(mesh);
  const base::ThreadLimit limit(1);
  const MeshReport one = check_mesh(mesh);
  EXPECT_EQ(all.area, one.area);
  EXPECT_EQ(all.volume, one.volume);
  expect_same(all, one);
  EXPECT_FALSE(all.defective(true));
}

TEST(CheckMesh, EveryStoreGivesTheSameFigures) {
  const Mesh wide = torus(40, 15);
  Mesh narrow;
  for (const Vec3& p : wide.positions_f64) {
    narrow.positions.push_back(
        {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  }
  narrow.triangles = wide.triangles;
  Mesh mesh = narrow;
  const MeshReport want = check_mesh(narrow);
  for (const int store : {0, 1}) {
    SCOPED_TRACE(store);
    if (store == 0) {  // 64-bit ids
      mesh.add_triangle({0, 0, std::uint64_t{1} << 32});
      ASSERT_TRUE(mesh.triangles.empty());
      mesh.triangles_u64.pop_back();
    } else {  // doubles too
      for (std::size_t v = 0; v < narrow.n_vertices(); ++v) {
        mesh.positions_f64.push_back(narrow.position(v));
      }
      mesh.positions.clear();
    }
    EXPECT_EQ(mesh.n_vertices(), narrow.n_vertices());
    EXPECT_EQ(mesh.n_triangles(), narrow.n_triangles());
    const MeshReport got = check_mesh(mesh);
    expect_same(got, want);
    EXPECT_EQ(got.area, want.area);
    EXPECT_EQ(got.volume, want.volume);
  }
}

TEST(CheckMesh, AgreesWithTheOracleOnRandomSoups) {
  for (unsigned seed = 0; seed < 400; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    const auto below = [&](std::uint64_t n) { return random() % n; };
    Mesh mesh;
    const std::uint64_t n_vertices = 1 + below(14);
    for (std::uint64_t v = 0; v < n_vertices; ++v) {
      const auto x = [&] { return static_cast<double>(below(4)) - 1; };
      mesh.positions_f64.push_back({x(), x(), x()});
    }
    if (seed % 7 == 0) {
      mesh.positions_f64[below(n_vertices)][1] = std::numeric_limits<double>::infinity();
    }
    const std::uint64_t range = n_vertices + (seed % 3 == 0 ? 1 : 0);
    for (std::uint64_t t = below(30); t > 0; --t) {
      mesh.add_triangle({below(range), below(range), below(range)});
    }
    expect_same(check_mesh(mesh), test::MeshOracle(mesh).report());
  }
}

TEST(CheckMesh, AgreesWithTheOracleOnDamagedTori) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    Mesh mesh = torus(9, 6);
    for (int n = 0; n < 4; ++n) {
      std::swap(mesh.triangles[random() % 100][random() % 3],
                mesh.triangles[random() % 100][random() % 3]);
      mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(random() % 100));
    }
    mesh.triangles.resize(mesh.triangles.size() - random() % 5);
    expect_same(check_mesh(mesh), test::MeshOracle(mesh).report());
  }
}

TEST(MeshOracle, KnowsACube) {
  const test::MeshOracle oracle(cube());
  EXPECT_TRUE(oracle.closed() && oracle.manifold() && oracle.oriented());
  EXPECT_EQ(oracle.euler(), 2);
  EXPECT_EQ(oracle.volume(), 8);
  EXPECT_EQ(oracle.area(), 24);
}

}  // namespace
}  // namespace mc
