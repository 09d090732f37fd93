// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "mc/pipe.hpp"
#include "pipe/cube_plan.hpp"
#include "support/cube_stages.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/mesh_oracle.hpp"
#include "support/mesh_stages.hpp"
#include "support/random_fields.hpp"
#include "support/same_mesh.hpp"

// Laws of cube stages: a run hands out the mesh that two plain passes over the whole mesh in memory
// make, cube by cube, whatever the threads, the memory and the slabs; the cubes fit together.

namespace mc::test {
namespace {

const Affine kTurned{{1.5, 0.25, 0, 10, 0, 2, 0.5, -20, 0.125, 0, 3, 30}};

Collected run_with(const VolumeReader& reader, const RunOptions& options, int threads) {
  const base::ThreadLimit limit(threads);
  Collected out;
  CollectingSink sink(out);
  out.totals = run(reader, options, true, sink, silent_progress(), {});
  return out;
}

/// Two passes over a mesh in memory, with maps of everything.
class PlainPasses {
 public:
  PlainPasses(const Collected& from, const RunOptions& options, const pipe::CubeGrid& grid)
      : mesh_(from), options_(options), grid_(grid) {}

  Collected operator()() {
    const auto n_mesh = mesh_.mesh.triangles.size();
    std::vector<double> stands_for(n_mesh, 1);
    std::vector<std::int32_t> layers(n_mesh);
    for (const bool shifted : {false, true}) pass(shifted, n_mesh, stands_for, layers);
    return std::move(mesh_);
  }

 private:
  struct Cube {
    std::vector<std::size_t> triangles;
  };

  Vec3 position(std::size_t vertex) const {
    if (mesh_.mesh.positions.empty()) return mesh_.mesh.positions_f64[vertex];
    const auto& p = mesh_.mesh.positions[vertex];
    return {p[0], p[1], p[2]};
  }

  void pass(bool shifted, std::size_t n_mesh, std::vector<double>& stands_for,
            std::vector<std::int32_t>& layers) {
    std::map<std::array<std::int32_t, 3>, Cube> cubes;
    std::vector<int> users(mesh_.mesh.n_vertices());
    std::int32_t z = std::numeric_limits<std::int32_t>::min();
    const auto& triangles = mesh_.mesh.triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const Vec3 p = position(triangles[t][0]);
      const Vec3 q = position(triangles[t][1]);
      const Vec3 r = position(triangles[t][2]);
      Vec3 middle{};
      for (std::size_t a = 0; a < 3; ++a) middle[a] = (p[a] + q[a] + r[a]) / 3;
      const auto [i, j, k] = grid_.cube_of(middle, shifted);
      std::array<std::int32_t, 3> cube{k, j, i};
      if (shifted) {
        cube[0] = std::clamp(cube[0], layers[t], layers[t] + 1);
      } else {
        cube[0] = z = std::max(z, cube[0]);
      }
      cubes[cube].triangles.push_back(t);
    }
    for (const auto& [at, cube] : cubes) {
      std::map<std::uint32_t, bool> used;
      for (const std::size_t t : cube.triangles) {
        for (const std::uint32_t v : triangles[t]) used[v] = true;
      }
      for (const auto& [v, is] : used) ++users[v];
    }
    Collected next;
    std::vector<double> next_stands_for;
    std::vector<std::int32_t> next_layers;
    std::map<std::uint32_t, std::uint32_t> numbers;
    for (const auto& [at, cube] : cubes) {
      make(cube, users, shifted, n_mesh, stands_for, numbers, next, next_stands_for);
      next_layers.resize(next.mesh.triangles.size(), at[0]);
    }
    next.totals.n_vertices = next.mesh.n_vertices();
    next.totals.n_triangles = next.mesh.n_triangles();
    mesh_ = std::move(next);
    stands_for = std::move(next_stands_for);
    layers = std::move(next_layers);
  }

  template <class Row, class T>
  static void copy(const Row& from, std::uint32_t v, Buffer<T>& to) {
    if (from.empty()) return;
    to.insert(to.end(), from[v].begin(), from[v].end());
  }

  void make(const Cube& cube, const std::vector<int>& users, bool shifted, std::size_t n_mesh,
            const std::vector<double>& stands_for, std::map<std::uint32_t, std::uint32_t>& numbers,
            Collected& next, std::vector<double>& next_stands_for) {
    std::map<std::pair<bool, std::uint32_t>, std::uint32_t> local;
    double n_extracted = 0;
    for (const std::size_t t : cube.triangles) {
      n_extracted += stands_for[t];
      for (const std::uint32_t v : mesh_.mesh.triangles[t]) local[{users[v] == 1, v}] = 0;
    }
    MeshChunk chunk;
    std::vector<std::uint32_t> seam;
    std::uint32_t n = 0;
    for (auto& [key, number] : local) {
      number = n++;
      copy(mesh_.mesh.positions, key.second, chunk.positions);
      copy(mesh_.mesh.positions_f64, key.second, chunk.positions_f64);
      copy(mesh_.mesh.normals, key.second, chunk.normals);
      if (!key.first) seam.push_back(key.second);
    }
    for (const std::size_t t : cube.triangles) {
      for (const std::uint32_t v : mesh_.mesh.triangles[t]) {
        chunk.indices.push_back(local.at({users[v] == 1, v}));
      }
    }
    const std::size_t before = chunk.n_triangles();
    MeshCube window{chunk, options_.extract.origin, seam.size(), 1, n_extracted, n_mesh, shifted};
    for (const CubeStage* stage : options_.cube_stages) stage->apply(window);
    EXPECT_LE(chunk.n_triangles(), before);
    append(chunk, seam, numbers, next);
    next_stands_for.resize(next.mesh.triangles.size(), 1);
  }

  static void append(const MeshChunk& chunk, const std::vector<std::uint32_t>& seam,
                     std::map<std::uint32_t, std::uint32_t>& numbers, Collected& next) {
    std::vector<std::uint32_t> ids;
    for (std::uint32_t v = 0; v < chunk.n_vertices(); ++v) {
      const auto id = static_cast<std::uint32_t>(next.mesh.n_vertices());
      if (v < seam.size()) {
        const auto [found, is_new] = numbers.try_emplace(seam[v], id);
        ids.push_back(found->second);
        if (!is_new) continue;
      } else {
        ids.push_back(id);
      }
      const auto add = [v](const auto& from, auto& to) {
        const std::size_t at = std::size_t{3} * v;
        if (!from.empty()) to.push_back({from[at], from[at + 1], from[at + 2]});
      };
      add(chunk.positions, next.mesh.positions);
      add(chunk.positions_f64, next.mesh.positions_f64);
      add(chunk.normals, next.mesh.normals);
    }
    for (std::size_t i = 0; i < chunk.indices.size(); i += 3) {
      next.mesh.triangles.push_back(
          {ids[chunk.indices[i]], ids[chunk.indices[i + 1]], ids[chunk.indices[i + 2]]});
    }
  }

  Collected mesh_;
  const RunOptions& options_;
  const pipe::CubeGrid& grid_;
};

void expect_true_figures(const Collected& got, const Collected& before) {
  const MeshOracle oracle(got.mesh);
  const MeshOracle plain(before.mesh);
  EXPECT_LT(got.totals.n_triangles, before.totals.n_triangles);
  EXPECT_EQ(oracle.report().nonmanifold_edges, 0U);
  EXPECT_EQ(oracle.report().nonmanifold_vertices, plain.report().nonmanifold_vertices);
  EXPECT_EQ(oracle.report().misoriented_edges, 0U);
  EXPECT_EQ(oracle.report().duplicate, 0U);
  EXPECT_EQ(oracle.report().unreferenced_vertices, 0U);
  EXPECT_EQ(oracle.report().components, plain.report().components);
  EXPECT_EQ(oracle.euler(), plain.euler());
  EXPECT_EQ(got.totals.euler(), plain.euler());
  EXPECT_EQ(got.totals.n_boundary_edges, oracle.report().boundary_edges);
  EXPECT_EQ(got.totals.n_extracted, before.totals.n_triangles);
  EXPECT_NEAR(got.totals.area.value(), oracle.area(), 1e-9 * oracle.area());
  EXPECT_EQ(got.totals.volume.has_value(), oracle.closed());
  if (got.totals.volume) {
    EXPECT_NEAR(*got.totals.volume, oracle.volume(), 1e-9 * oracle.area());
  }
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_EQ(got.totals.bounds.lo[a], oracle.report().bounds.lo[a]);
    EXPECT_EQ(got.totals.bounds.hi[a], oracle.report().bounds.hi[a]);
  }
}

/// Runs that differ in how, not in what.
void compare_runs(const VolumeReader& reader, const RunOptions& options) {
  RunOptions plain = options;
  plain.cube_stages = {};
  const Collected before = run_with(reader, plain, 1);
  const pipe::CubeGrid grid = pipe::cube_grid(volume_of(reader), is_dense(reader), options);
  const Collected want = PlainPasses(before, options, grid)();
  const Collected first = run_with(reader, options, 1);
  if (options.extract.precision == Precision::f32) expect_true_figures(first, before);
  for (const int threads : {1, 2, 7}) {
    for (const auto& [layers, least] : {std::pair{0, false}, {0, true}, {1, false}, {3, false}}) {
      SCOPED_TRACE(testing::Message() << threads << " threads, " << layers << " layers, "
                                      << (least ? "least" : "default") << " memory");
      RunOptions o = options;
      o.slab_layers = layers;
      o.count_first = layers == 3 ? CountFirst::yes : CountFirst::no;
      if (layers == 1) o.chunk_bytes = 20'000;
      if (least) o.memory_bytes = memory_needed(reader, o).least;
      const Collected got = run_with(reader, o, threads);
      expect_same_mesh(got, want);
      EXPECT_EQ(got.totals.area, first.totals.area);
      EXPECT_EQ(got.totals.volume, first.totals.volume);
      EXPECT_EQ(got.totals.n_boundary_edges, first.totals.n_boundary_edges);
      EXPECT_EQ(got.totals.bounds.lo, first.totals.bounds.lo);
      EXPECT_EQ(got.totals.distances.has_value(), first.totals.distances.has_value());
      EXPECT_EQ(got.object.n_vertices.has_value(), layers == 3);
      if (got.object.n_vertices) {
        EXPECT_EQ(*got.object.n_vertices, got.totals.n_vertices);
        EXPECT_EQ(*got.object.n_triangles, got.totals.n_triangles);
      }
    }
  }
}

struct Lists {
  Untouched untouched{8};
  Unpeg unpeg{8}, small{6}, large{64};
  Untouched six{6};
  std::vector<std::vector<const CubeStage*>> all{
      {&untouched, &unpeg}, {&unpeg}, {&small, &six, &small}, {&large}, {&unpeg}, {&small}};
};

RunOptions options_for(const std::vector<const CubeStage*>& stages, std::uint64_t seed) {
  RunOptions options;
  options.extract.iso = 0.25;
  options.extract.border = seed % 2 == 0 ? Border::open : Border::closed;
  options.extract.normals = Normals(seed % 3);
  options.extract.measure = true;
  if (seed % 4 == 3) {
    options.extract.precision = Precision::f64;
    options.extract.origin = {1, 2, -3};
  }
  options.cube_stages = stages;
  return options;
}

TEST(CubeStages, OfADenseMeshAreTwoPassesOverAllCubes) {
  const Lists lists;
  const Index3 dims{21, 17, 37};
  for (std::uint64_t seed = 0; seed < lists.all.size(); ++seed) {
    SCOPED_TRACE(testing::Message() << "stages " << seed);
    const auto samples = random_field<float>(dims, Noise(seed % 2), seed);
    const VolumeReader reader =
        owned(std::unique_ptr<SlabReader>(new MemorySlabs(samples, dims, kTurned)));
    RunOptions options = options_for(lists.all[seed], seed);
    if (seed >= 4) options.extract.region = IndexBox{{1, 3, 2}, {18, 15, 33}};
    compare_runs(reader, options);
    ASSERT_FALSE(testing::Test::HasFailure());
  }
}

TEST(CubeStages, FollowStagesOfWindowsAndOfSingleChunks) {
  const Unpeg unpeg(8);
  const std::vector<const CubeStage*> cubes{&unpeg};
  const Smooth smooth(2);
  const Bend bend;
  const Cut cut;
  const Bare bare;
  const Index3 dims{21, 17, 37};
  const VolumeReader reader = owned(std::unique_ptr<SlabReader>(
      new MemorySlabs(random_field<float>(dims, Noise::white, 3), dims, kTurned)));
  for (const std::vector<const MeshStage*>& stages :
       std::vector<std::vector<const MeshStage*>>{{&smooth}, {&bend}, {&bend, &cut}, {&bare}}) {
    RunOptions options = options_for(cubes, 0);
    options.stages = stages;
    compare_runs(reader, options);
    ASSERT_FALSE(testing::Test::HasFailure());
  }
}

/// Noise in balls that lie far apart.
VolumeReader sparse_balls(std::uint64_t seed) {
  const Index3 dims{40, 24, 120};
  std::vector<float> field = random_field<float>(dims, Noise::white, seed);
  std::size_t at = 0;
  for (std::int32_t k = 0; k < dims[2]; ++k) {
    for (std::int32_t j = 0; j < dims[1]; ++j) {
      for (std::int32_t i = 0; i < dims[0]; ++i, ++at) {
        const auto near = [&](double x, double z) {
          return std::hypot(i - x, j - 11.5, k - z) < 8;
        };
        if (!near(12, 14) && !near(22, 25) && !near(12, 101)) field[at] = 0;
      }
    }
  }
  return owned(
      std::unique_ptr<LeafReader>(new MemoryLeaves(field, dims, {-8, 0, -24}, 0.F, kTurned)));
}

TEST(CubeStages, OfASparseMeshAreTwoPassesOverAllCubes) {
  const Lists lists;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    SCOPED_TRACE(testing::Message() << "stages " << seed);
    RunOptions options = options_for(lists.all[seed], seed);
    if (seed % 2 == 1) options.extract.region = IndexBox{{-6, 2, -20}, {20, 19, 90}};
    compare_runs(sparse_balls(seed), options);
    ASSERT_FALSE(testing::Test::HasFailure());
  }
}

TEST(CubeStages, ThatChangeNothingLeaveTheSameTriangles) {
  const Untouched untouched(8);
  const std::vector<const CubeStage*> stages{&untouched};
  const Index3 dims{21, 17, 37};
  const VolumeReader reader = owned(std::unique_ptr<SlabReader>(
      new MemorySlabs(random_field<float>(dims, Noise::white, 3), dims)));
  const auto places = [&](CubeStages cube_stages) {
    RunOptions options;
    options.extract.iso = 0.25;
    options.cube_stages = cube_stages;
    const Collected got = run_with(reader, options, 2);
    std::vector<std::array<std::array<float, 3>, 3>> out;
    for (const auto& t : got.mesh.triangles) {
      out.push_back({got.mesh.positions[t[0]], got.mesh.positions[t[1]], got.mesh.positions[t[2]]});
    }
    std::ranges::sort(out);
    return std::pair{out, got.mesh.n_vertices()};
  };
  EXPECT_EQ(places(stages), places({}));
}

}  // namespace
}  // namespace mc::test
