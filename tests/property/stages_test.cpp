// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "mc/pipe.hpp"
#include "process/figures.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/mesh_oracle.hpp"
#include "support/mesh_stages.hpp"
#include "support/random_fields.hpp"
#include "support/same_mesh.hpp"

// Laws of stages: the mesh that a run hands out is the one that the stages make of the whole mesh
// in memory, byte for byte, whatever the threads, the memory and the slabs; and so are its figures.

namespace mc::test {
namespace {

const Affine kTurned{{1.5, 0.25, 0, 10, 0, 2, 0.5, -20, 0.125, 0, 3, 30}};

using Stages = std::vector<const MeshStage*>;

Collected run_with(const VolumeReader& reader, const RunOptions& options, int threads) {
  const base::ThreadLimit limit(threads);
  Collected out;
  CollectingSink sink(out);
  out.totals = run(reader, options, true, sink, silent_progress(), {});
  return out;
}

/// The stages applied to one window that is the whole mesh.
Collected whole_with(const VolumeReader& reader, const RunOptions& options) {
  RunOptions plain = options;
  plain.stages = {};
  Collected out = run_with(reader, plain, 1);
  MeshChunk mesh;
  for (const auto& p : out.mesh.positions)
    mesh.positions.insert(mesh.positions.end(), p.begin(), p.end());
  for (const auto& p : out.mesh.positions_f64)
    mesh.positions_f64.insert(mesh.positions_f64.end(), p.begin(), p.end());
  for (const auto& n : out.mesh.normals)
    mesh.normals.insert(mesh.normals.end(), n.begin(), n.end());
  for (const auto& t : out.mesh.triangles)
    mesh.indices.insert(mesh.indices.end(), t.begin(), t.end());
  MeshWindow window{mesh, options.extract.origin, {0, mesh.n_vertices()}, {0, mesh.n_triangles()}};
  for (const MeshStage* stage : options.stages) stage->apply(window);
  const MeshTotals before = out.totals;
  out = {};
  CollectingSink(out).place(mesh, 0);
  out.totals = before;
  out.totals.n_vertices = mesh.n_vertices();
  out.totals.n_triangles = mesh.n_triangles();
  out.totals.bounds = process::bounds_of(mesh);
  return out;
}

/// Of a mesh in single precision without an origin.
void expect_true_figures(const Collected& got) {
  const MeshOracle oracle(got.mesh);
  EXPECT_EQ(got.totals.n_boundary_edges, oracle.report().boundary_edges);
  if (got.totals.area) {
    EXPECT_NEAR(*got.totals.area, oracle.area(), 1e-9 * oracle.area());
  }
  if (got.totals.volume) {
    EXPECT_NEAR(*got.totals.volume, oracle.volume(), 1e-9 * oracle.area());
  }
  for (std::size_t a = 0; a < 3; ++a) {
    float lo = got.mesh.positions[0][a];
    float hi = lo;
    for (const auto& p : got.mesh.positions) {
      lo = std::min(lo, p[a]);
      hi = std::max(hi, p[a]);
    }
    EXPECT_EQ(got.totals.bounds.lo[a], double{lo});
    EXPECT_EQ(got.totals.bounds.hi[a], double{hi});
  }
}

struct Lists {
  Bend bend;
  Bare bare;
  Smooth once{1}, thrice{3};
  Cut cut;
  Lean lean;
  Pick pick;
  std::vector<Stages> all{{&bend},
                          {&bare, &bend},
                          {&once},
                          {&thrice, &bend},
                          {&bend, &once, &bare, &thrice},
                          {&cut},
                          {&once, &cut, &bend},
                          {&bend, &cut, &once, &cut},
                          {&lean},
                          {&pick},
                          {&lean, &cut, &pick}};
};

/// Runs that differ in how, not in what.
void compare_runs(const VolumeReader& reader, const RunOptions& options) {
  const Collected want = whole_with(reader, options);
  ASSERT_FALSE(want.mesh.triangles.empty());
  const Collected first = run_with(reader, options, 1);
  if (options.extract.precision == Precision::f32 && options.extract.origin == Vec3{}) {
    expect_true_figures(first);
  }
  for (const int threads : {1, 2, 7}) {
    for (const auto& [layers, least] : {std::pair{0, false}, {0, true}, {1, false}, {3, false}}) {
      SCOPED_TRACE(testing::Message() << threads << " threads, " << layers << " layers, "
                                      << (least ? "least" : "default") << " memory");
      RunOptions o = options;
      o.slab_layers = layers;
      o.count_first = layers == 3 ? CountFirst::yes : CountFirst::no;
      if (least) o.memory_bytes = memory_needed(reader, o).least;
      const Collected got = run_with(reader, o, threads);
      expect_same_mesh(got, want);
      EXPECT_EQ(got.totals.area, first.totals.area);
      EXPECT_EQ(got.totals.volume, first.totals.volume);
      EXPECT_EQ(got.totals.n_boundary_edges, first.totals.n_boundary_edges);
      EXPECT_EQ(got.totals.bounds.lo, first.totals.bounds.lo);
      EXPECT_EQ(got.totals.bounds.hi, first.totals.bounds.hi);
      if (got.object.n_vertices) {
        EXPECT_EQ(*got.object.n_vertices, got.totals.n_vertices);
        EXPECT_EQ(*got.object.n_triangles, got.totals.n_triangles);
      }
      EXPECT_EQ(got.object.n_vertices.has_value() || layers != 3, true);
    }
  }
}

RunOptions options_for(const Stages& stages, std::uint64_t seed) {
  RunOptions options;
  options.extract.iso = 0.25;
  options.extract.border = Border(seed % 3);
  options.extract.normals = Normals(seed % 3);
  options.extract.measure = true;
  if (seed % 4 == 3) {
    options.extract.precision = Precision::f64;
    options.extract.origin = {1, 2, -3};
  }
  options.stages = stages;
  return options;
}

TEST(Stages, OfADenseMeshAreThoseOfTheWholeMesh) {
  const Lists lists;
  const Index3 dims{14, 9, 29};
  for (std::uint64_t seed = 0; seed < lists.all.size(); ++seed) {
    SCOPED_TRACE(testing::Message() << "stages " << seed);
    const auto samples = random_field<float>(dims, Noise(seed % 2), seed);
    const VolumeReader reader =
        owned(std::unique_ptr<SlabReader>(new MemorySlabs(samples, dims, kTurned)));
    compare_runs(reader, options_for(lists.all[seed], seed));
    ASSERT_FALSE(testing::Test::HasFailure());
  }
}

/// Noise in three balls, of which two lie far apart.
std::vector<float> balls(const Index3& dims, std::uint64_t seed) {
  std::vector<float> field = random_field<float>(dims, Noise::white, seed);
  std::size_t at = 0;
  for (std::int32_t k = 0; k < dims[2]; ++k) {
    for (std::int32_t j = 0; j < dims[1]; ++j) {
      for (std::int32_t i = 0; i < dims[0]; ++i, ++at) {
        const auto near = [&](double z) { return std::hypot(i - 12.5, j - 7.5, k - z) < 7; };
        if (!near(12) && !near(25) && !near(75)) field[at] = 0;
      }
    }
  }
  return field;
}

VolumeReader sparse_balls(std::uint64_t seed) {
  const Index3 dims{24, 16, 88};
  return owned(std::unique_ptr<LeafReader>(
      new MemoryLeaves(balls(dims, seed), dims, {-8, 0, -24}, 0.F, kTurned)));
}

TEST(Stages, OfASparseMeshAreThoseOfTheWholeMesh) {
  const Lists lists;
  for (std::uint64_t seed = 0; seed < lists.all.size(); ++seed) {
    SCOPED_TRACE(testing::Message() << "stages " << seed);
    RunOptions options = options_for(lists.all[seed], seed);
    if (seed % 2 == 0) options.extract.region = IndexBox{{-6, 2, -20}, {10, 13, 50}};
    compare_runs(sparse_balls(seed), options);
    ASSERT_FALSE(testing::Test::HasFailure());
  }
}

void compare_parts(const VolumeReader& reader, RunOptions options) {
  const Collected want = whole_with(reader, options);
  const LayerRange all = part_layers(reader, options);
  const std::int32_t third = (all.last - all.first) / 3;
  Collected joined;
  for (const LayerRange& part : {LayerRange{all.first, all.first + third},
                                 LayerRange{all.first + third, all.first + third + 1},
                                 LayerRange{all.first + third + 1, all.last}}) {
    options.extract.part = part;
    append_mesh(run_with(reader, options, 2), joined);
  }
  expect_same_mesh(joined, want);
}

TEST(Stages, OfPartsAreThoseOfTheWholeMesh) {
  const Lists lists;
  const Index3 dims{14, 9, 29};
  const VolumeReader dense = owned(std::unique_ptr<SlabReader>(
      new MemorySlabs(random_field<float>(dims, Noise::white, 5), dims, kTurned)));
  for (std::uint64_t seed = 0; seed < lists.all.size(); ++seed) {
    SCOPED_TRACE(testing::Message() << "stages " << seed);
    compare_parts(dense, options_for(lists.all[seed], seed));
    compare_parts(sparse_balls(seed), options_for(lists.all[seed], seed));
  }
}

}  // namespace
}  // namespace mc::test
