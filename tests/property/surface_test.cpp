// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mc/extract.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/mesh_oracle.hpp"
#include "support/random_fields.hpp"

// Laws of every surface, over random fields and over shapes whose figures are known.

namespace mc::test {
namespace {

template <class T>
Collected surface_of(const std::vector<T>& samples, Index3 dims, const ExtractOptions& o,
                     const Affine& map = {}) {
  const VolumeReader reader =
      owned(std::unique_ptr<SlabReader>(new MemorySlabs(samples, dims, map)));
  return collect(reader, o);
}

TEST(Surface, OneSampleInsideGivesEightTriangles) {
  std::vector<float> samples(27, 0.F);
  samples[13] = 1;
  const Mesh mesh = extract(View3<const float>(samples.data(), {3, 3, 3}), {.iso = 0.5});
  EXPECT_EQ(mesh.positions.size(), 6U);
  EXPECT_EQ(mesh.triangles.size(), 8U);
  EXPECT_EQ(mesh.normals.size(), 6U);
}

// 6x6x6 samples inside: 36 crossed edges on each of six sides, and V - E + F = 2.
TEST(Surface, ABlockGivesWhatPaperGives) {
  std::vector<std::uint8_t> samples(8 * 8 * 8, 0);
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const std::size_t i = n % 8, j = n / 8 % 8, k = n / 64;
    samples[n] = i > 0 && i < 7 && j > 0 && j < 7 && k > 0 && k < 7 ? 200 : 10;
  }
  const Mesh mesh = extract(View3<const std::uint8_t>(samples.data(), {8, 8, 8}), {.iso = 100});
  EXPECT_EQ(mesh.positions.size(), 216U);
  EXPECT_EQ(mesh.triangles.size(), 428U);
  EXPECT_TRUE(MeshOracle(mesh).closed());
  EXPECT_GT(MeshOracle(mesh).volume(), 0);
}

/// Watertight, manifold, oriented, and nothing degenerate: what every default mesh must be.
void expect_sound(const Collected& got, bool closed) {
  const MeshReport report = check_mesh(got.mesh);
  ASSERT_FALSE(report.defective(closed));
  ASSERT_EQ(report.unreferenced_vertices, 0U);
  ASSERT_EQ(report.duplicate_vertices, 0U);
  ASSERT_EQ(report.boundary_edges, got.totals.n_boundary_edges);
  ASSERT_EQ(report.euler, got.totals.euler());
  ASSERT_EQ(got.totals.volume.has_value(), got.totals.area.has_value() && report.closed());
  if (got.totals.volume) {
    ASSERT_NEAR(report.volume, *got.totals.volume, 1e-6 * (1 + report.area));
  }
  if (got.totals.area) {
    ASSERT_NEAR(report.area, *got.totals.area, 1e-6 * (1 + report.area));
  }
}

void check_random_grids(Noise noise, std::uint64_t first_seed, int n_seeds) {
  const Index3 dims{5, 5, 5};
  for (int n = 0; n < n_seeds; ++n) {
    const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(n);
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const auto samples = random_field<float>(dims, noise, seed);
    ExtractOptions o;
    o.iso = 0.25;
    o.inside = seed % 2 == 0 ? Inside::above : Inside::below;
    o.normals = Normals::none;
    o.measure = seed % 16 == 0;
    expect_sound(surface_of(samples, dims, o), false);
    o.border = Border::closed;
    const Collected capped = surface_of(samples, dims, o);
    expect_sound(capped, true);
    ASSERT_FALSE(testing::Test::HasFatalFailure());
    if (!capped.mesh.triangles.empty()) {
      ASSERT_GT(check_mesh(capped.mesh).volume, 0);
    }
  }
}

TEST(Surface, RandomGridsOfWhiteNoiseAreManifold) { check_random_grids(Noise::white, 0, 4000); }
TEST(Surface, RandomGridsWithPlateausAtIsoAreManifold) {
  check_random_grids(Noise::plateaus, 10000, 3000);
}
TEST(Surface, RandomGridsWithNanAreManifold) { check_random_grids(Noise::with_nan, 20000, 3000); }

/// f(x, y, z) over n samples an axis of [-1.25, 1.25]^3.
template <class F>
Collected sampled(int n, F&& f, const ExtractOptions& o) {
  std::vector<float> samples;
  const double h = 2.5 / (n - 1);
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        samples.push_back(static_cast<float>(f(-1.25 + i * h, -1.25 + j * h, -1.25 + k * h)));
      }
    }
  }
  return surface_of(samples, {n, n, n}, o,
                    Affine::scale_translate({h, h, h}, {-1.25, -1.25, -1.25}));
}

double sphere(double x, double y, double z) { return 1 - std::sqrt(x * x + y * y + z * z); }
double torus(double x, double y, double z) {
  const double ring = std::sqrt(x * x + y * y) - 0.75;
  return 0.3 - std::sqrt(ring * ring + z * z);
}

template <class F>
void expect_second_order(F&& f, double area, double volume, std::int64_t euler) {
  ExtractOptions o;
  o.normals = Normals::none;
  o.measure = true;
  double last_area = 0;
  double last_volume = 0;
  for (const int cells : {32, 64, 128}) {
    const Collected got = sampled(cells + 1, f, o);
    expect_sound(got, true);
    EXPECT_EQ(got.totals.euler(), euler);
    const double area_error = std::abs(*got.totals.area - area);
    const double volume_error = std::abs(*got.totals.volume - volume);
    if (cells > 32) {
      EXPECT_NEAR(last_area / area_error, 4, 0.35) << cells;
      EXPECT_NEAR(last_volume / volume_error, 4, 0.35) << cells;
    }
    last_area = area_error;
    last_volume = volume_error;
  }
}

TEST(Surface, SphereConvergesAtSecondOrder) {
  const double pi = std::numbers::pi;
  expect_second_order(sphere, 4 * pi, 4 * pi / 3, 2);
}
TEST(Surface, TorusConvergesAtSecondOrder) {
  const double pi = std::numbers::pi;
  expect_second_order(torus, 4 * pi * pi * 0.75 * 0.3, 2 * pi * pi * 0.75 * 0.3 * 0.3, 0);
}

// An ellipsoid under anisotropic spacing is a sphere in the world: normals must be the sphere's.
TEST(Surface, NormalsFollowTheWorldNotTheLattice) {
  const Index3 dims{41, 21, 81};
  for (const double mirror : {1.0, -1.0}) {
    const Affine map =
        Affine::scale_translate({mirror * 0.0625, 0.125, 0.03125}, {mirror * -1.25, -1.25, -1.25});
    std::vector<float> samples;
    for (int k = 0; k < dims[2]; ++k) {
      for (int j = 0; j < dims[1]; ++j) {
        for (int i = 0; i < dims[0]; ++i) {
          const Vec3 p =
              map({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
          samples.push_back(static_cast<float>(-sphere(p[0], p[1], p[2])));
        }
      }
    }
    for (const Normals normals : {Normals::gradient, Normals::face}) {
      ExtractOptions o;
      o.inside = Inside::below;
      o.normals = normals;
      o.measure = true;
      const Collected got = surface_of(samples, dims, o, map);
      expect_sound(got, true);
      EXPECT_GT(*got.totals.volume, 4.1);
      const float tolerance = normals == Normals::gradient ? 0.02F : 0.1F;
      for (std::size_t n = 0; n < got.mesh.positions.size(); ++n) {
        for (std::size_t a = 0; a < 3; ++a) {
          ASSERT_NEAR(got.mesh.normals[n][a], got.mesh.positions[n][a], tolerance);
        }
      }
    }
  }
}

// A ramp is cut in a plane: every vertex on it, every normal along it, also at the borders.
TEST(Surface, APlaneIsExact) {
  const Index3 dims{9, 8, 7};
  std::vector<float> samples;
  for (int k = 0; k < dims[2]; ++k) {
    for (int j = 0; j < dims[1]; ++j) {
      for (int i = 0; i < dims[0]; ++i) samples.push_back(static_cast<float>(i + 2 * j + 3 * k));
    }
  }
  ExtractOptions o;
  o.iso = 20.3;
  o.min_edge = 0;
  const Collected got = surface_of(samples, dims, o);
  ASSERT_GT(got.mesh.positions.size(), 20U);
  const double length = std::sqrt(14.0);
  for (std::size_t n = 0; n < got.mesh.positions.size(); ++n) {
    const auto& p = got.mesh.positions[n];
    EXPECT_NEAR(p[0] + 2 * p[1] + 3 * p[2], 20.3, 1e-5);
    EXPECT_NEAR(got.mesh.normals[n][0], -1 / length, 1e-6);
    EXPECT_NEAR(got.mesh.normals[n][1], -2 / length, 1e-6);
    EXPECT_NEAR(got.mesh.normals[n][2], -3 / length, 1e-6);
  }
}

TEST(Surface, CapsAreFlatToMinEdgeAndLookOutward) {
  const Index3 dims{4, 5, 6};
  const std::vector<float> samples(4 * 5 * 6, 1.F);
  ExtractOptions o;
  o.iso = 0.5;
  o.border = Border::closed;
  o.measure = true;
  const Collected got = surface_of(samples, dims, o);
  expect_sound(got, true);
  EXPECT_EQ(got.totals.euler(), 2);
  const double e = 1.0 / 1024;
  for (std::size_t n = 0; n < got.mesh.positions.size(); ++n) {
    int outside = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const float x = got.mesh.positions[n][a];
      const auto last = static_cast<double>(dims[a] - 1);
      if (x < 0 || x > last) {
        ++outside;
        EXPECT_NEAR(x < 0 ? -x : x - last, e, 1e-6);
        EXPECT_EQ(got.mesh.normals[n][a], x < 0 ? -1.F : 1.F);
      }
    }
    EXPECT_EQ(outside, 1);
  }
}

TEST(Surface, NothingAboveOrNothingBelowIsEmpty) {
  const std::vector<float> samples(64, 1.F);
  for (const double iso : {0.5, 1.0, 2.0, -1e30, 1e30}) {
    const Collected got = surface_of(samples, {4, 4, 4}, {.iso = iso});
    EXPECT_EQ(got.mesh.triangles.size(), 0U) << iso;
    EXPECT_EQ(got.n_objects, 1);
  }
}

TEST(Surface, IntegersCompareWithTheCeilingOfIso) {
  std::vector<std::uint8_t> samples(27, 10);
  samples[13] = 255;
  const auto triangles = [&](double iso) {
    return extract(View3<const std::uint8_t>(samples.data(), {3, 3, 3}), {.iso = iso})
        .triangles.size();
  };
  EXPECT_EQ(triangles(254.5), 8U);
  EXPECT_EQ(triangles(255), 8U);
  EXPECT_EQ(triangles(255.5), 0U);
  EXPECT_EQ(triangles(1e9), 0U);
  EXPECT_EQ(triangles(10.5), 8U);
  EXPECT_EQ(triangles(10), 0U);
  EXPECT_EQ(triangles(-1e9), 0U);
}

TEST(Surface, TheLibraryRefusesWhatCannotBe) {
  const std::vector<float> samples(8, 0.F);
  EXPECT_THROW(extract(View3<const float>(samples.data(), {8, 1, 1}), {}), Error);
  EXPECT_THROW(extract(View3<const float>(samples.data(), {2, 2, 2}),
                       {.iso = std::numeric_limits<double>::quiet_NaN()}),
               Error);
}

}  // namespace
}  // namespace mc::test
