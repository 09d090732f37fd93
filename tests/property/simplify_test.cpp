// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <vector>

#include "base/parallel.hpp"
#include "mc/pipe.hpp"
#include "mc/simplify.hpp"
#include "process/simplify/triangle_distance.hpp"
#include "support/memory_readers.hpp"
#include "support/mesh_collector.hpp"
#include "support/mesh_oracle.hpp"
#include "support/random_fields.hpp"
#include "support/same_mesh.hpp"

// Laws of simplification: no defect that the mesh did not have, the same components, Euler number
// and border, on vertices that were there; the same for any number of threads.

namespace mc::test {
namespace {

/// In small cubes, so that small fields have many seams.
class SimplifyInCubes final : public Simplify {
 public:
  SimplifyInCubes(const SimplifyGoal& goal, std::int32_t n_cells)
      : Simplify(goal), n_cells_(n_cells) {}
  [[nodiscard]] std::int32_t n_cells() const override { return n_cells_; }

 private:
  std::int32_t n_cells_;
};

Collected run_with(const VolumeReader& reader, const RunOptions& options, int threads) {
  const base::ThreadLimit limit(threads);
  Collected out;
  CollectingSink sink(out);
  out.totals = run(reader, options, true, sink, silent_progress(), {});
  return out;
}

VolumeReader dense(const Index3& dims, Noise noise, std::uint64_t seed) {
  return owned(std::unique_ptr<SlabReader>(
      new MemorySlabs(random_field<float>(dims, noise, seed), dims,
                      Affine::scale_translate({1, 1, 1.5}, {5, -3, 2}))));
}

RunOptions options_for(std::uint64_t seed) {
  RunOptions options;
  options.extract.iso = 0.25;
  options.extract.border = seed % 2 == 0 ? Border::closed : Border::open;
  options.extract.normals = Normals((seed + seed / 3) % 3);
  return options;
}

void expect_no_new_defects(const Collected& got, const Collected& before) {
  const MeshReport now = MeshOracle(got.mesh).report();
  const MeshReport then = MeshOracle(before.mesh).report();
  EXPECT_FALSE(now.defective(false));
  EXPECT_EQ(now.duplicate_vertices, 0U);
  EXPECT_EQ(now.unreferenced_vertices, 0U);
  EXPECT_EQ(now.boundary_edges, then.boundary_edges);
  EXPECT_EQ(now.components, then.components);
  EXPECT_EQ(now.euler, then.euler);
  const auto sorted = [](const Collected& mesh) {
    std::vector<std::array<float, 6>> out;
    for (std::size_t v = 0; v < mesh.mesh.positions.size(); ++v) {
      const auto& p = mesh.mesh.positions[v];
      const auto n = mesh.mesh.normals.empty() ? std::array<float, 3>{} : mesh.mesh.normals[v];
      out.push_back({p[0], p[1], p[2], n[0], n[1], n[2]});
    }
    std::ranges::sort(out);
    return out;
  };
  const auto ours = sorted(got);
  const auto all = sorted(before);
  EXPECT_TRUE(std::ranges::includes(all, ours));
}

TEST(Simplification, OfRandomFieldsMakesNoDefects) {
  const Index3 dims{29, 25, 41};
  for (std::uint64_t seed = 0; seed < 9; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const VolumeReader reader =
        dense(dims, std::array{Noise::white, Noise::plateaus, Noise::smooth}[seed % 3], seed);
    RunOptions options = options_for(seed);
    const Collected before = run_with(reader, options, 1);
    const SimplifyInCubes simplify({.ratio = seed % 2 == 0 ? 0.1 : 0.5},
                                   std::array{8, 12, 64}[seed / 3 % 3]);
    const std::array<const CubeStage*, 1> stages{&simplify};
    options.cube_stages = stages;
    const Collected got = run_with(reader, options, 2);
    expect_no_new_defects(got, before);
    EXPECT_LT(got.totals.n_triangles, before.totals.n_triangles);
    ASSERT_FALSE(testing::Test::HasFailure());
  }
}

/// Waves of a length that lets a tenth of the triangles do.
VolumeReader waves(const Index3& dims) {
  std::vector<float> field;
  for (std::int32_t k = 0; k < dims[2]; ++k) {
    for (std::int32_t j = 0; j < dims[1]; ++j) {
      for (std::int32_t i = 0; i < dims[0]; ++i) {
        field.push_back(static_cast<float>(std::sin(0.2 * i) * std::cos(0.2 * j) +
                                           std::sin(0.2 * j) * std::cos(0.2 * k) +
                                           std::sin(0.2 * k) * std::cos(0.2 * i)));
      }
    }
  }
  return owned(std::unique_ptr<SlabReader>(new MemorySlabs(field, dims)));
}

TEST(Simplification, ReachesRatiosAndCounts) {
  const VolumeReader reader = waves({70, 66, 72});
  RunOptions options = options_for(0);
  options.extract.border = Border::closed;
  const double n_before = static_cast<double>(run_with(reader, options, 2).totals.n_triangles);
  for (const double ratio : {0.1, 0.5}) {
    const SimplifyInCubes simplify({.ratio = ratio}, 32);
    const std::array<const CubeStage*, 1> stages{&simplify};
    options.cube_stages = stages;
    const Collected got = run_with(reader, options, 2);
    EXPECT_NEAR(static_cast<double>(got.totals.n_triangles) / n_before, ratio, 0.01 * ratio);
  }
  const SimplifyInCubes simplify({.by = SimplifyGoal::By::count, .count = 5000}, 32);
  const std::array<const CubeStage*, 1> stages{&simplify};
  options.cube_stages = stages;
  EXPECT_NEAR(static_cast<double>(run_with(reader, options, 2).totals.n_triangles), 5000, 50);
}

TEST(Simplification, MeasuresAtMostTheTrueDistances) {
  const VolumeReader reader = waves({24, 20, 28});
  RunOptions options = options_for(0);
  const Collected before = run_with(reader, options, 1);
  for (const double error : {0.02, 0.1}) {
    const SimplifyInCubes simplify({.by = SimplifyGoal::By::error, .error = error}, 16);
    const std::array<const CubeStage*, 1> stages{&simplify};
    options.cube_stages = stages;
    const Collected got = run_with(reader, options, 1);
    double squares = 0;
    double max = 0;
    for (std::size_t v = 0; v < before.mesh.n_vertices(); ++v) {
      double least = 1e30;
      for (const auto& t : got.mesh.triangles) {
        least =
            std::min(least, process::nearest_point(before.mesh.position(v), got.mesh.position(t[0]),
                                                   got.mesh.position(t[1]), got.mesh.position(t[2]))
                                .square);
      }
      squares += least;
      max = std::max(max, least);
    }
    const MeshDistances told = got.totals.distances.value();
    EXPECT_LE(std::sqrt(squares / static_cast<double>(before.mesh.n_vertices())), told.rms);
    EXPECT_LE(std::sqrt(max), told.max);
    EXPECT_LT(told.rms, 2 * error);
    EXPECT_LT(got.totals.n_triangles, before.totals.n_triangles / 2);
  }
}

TEST(Simplification, DoesNotDependOnThreadsMemoryOrSlabs) {
  const VolumeReader reader = dense({29, 25, 41}, Noise::white, 1);
  const SimplifyInCubes simplify({.ratio = 0.3}, 8);
  const std::array<const CubeStage*, 1> stages{&simplify};
  RunOptions options = options_for(0);
  options.cube_stages = stages;
  const Collected want = run_with(reader, options, 1);
  for (const int threads : {1, 2, 7}) {
    for (const bool least : {false, true}) {
      RunOptions o = options;
      o.slab_layers = least ? 0 : threads;
      if (least) o.memory_bytes = memory_needed(reader, o).least;
      const Collected got = run_with(reader, o, threads);
      expect_same_mesh(got, want);
      EXPECT_EQ(got.totals.distances->rms, want.totals.distances->rms);
      EXPECT_EQ(got.totals.distances->max, want.totals.distances->max);
    }
  }
}

}  // namespace
}  // namespace mc::test
