// SPDX-License-Identifier: MIT
#include <array>
#include <cstring>
#include <memory>
#include <random>

#include "extract/cubes/vertex_kernels.hpp"
#include "kernel_bench.hpp"

// A batch of crossed edges to vertices: where they are cut, where that lies in the world, and the
// normal there; f32 samples. Parameters are compared to the bit, the rest within rounding.

namespace mc::bench {

namespace {

using extraction::EdgeRule;

constexpr std::size_t kBatch = 1024;

struct Batch {
  ExtractOptions options;
  extraction::Placement placement{Affine::scale_translate({0.7, 0.8, 0.9}, {-3, 5, 11}), options};
  EdgeRule<float> rule{options};
  std::array<std::vector<std::int32_t>, 4> places;  ///< i, j, k, axis
  std::array<std::vector<float>, 6> gradients;      ///< at the lower samples, then at the upper
  std::vector<float> a, b, t, positions, normals;
  std::vector<std::uint32_t> failed = std::vector<std::uint32_t>(kBatch);
  Bounds bounds;
  std::size_t n_failed = 0;

  Batch() {
    std::mt19937 random(1);  // the same on every machine
    const auto unit = [&] { return static_cast<float>(random()) / 4294967296.0F; };
    for (std::size_t n = 0; n < kBatch; ++n) {
      for (std::size_t c = 0; c < 3; ++c) places[c].push_back(static_cast<int>(random() % 512));
      places[3].push_back(static_cast<int>(random() % 3));
      a.push_back(unit());
      b.push_back(-unit());
      for (auto& gradient : gradients) gradient.push_back(unit() - 0.5F);
    }
    t.resize(kBatch);
    positions.resize(3 * kBatch);
    normals.resize(3 * kBatch);
    cut();
  }

  void cut() { extraction::cut_edges(rule, a.data(), b.data(), kBatch, t.data()); }
  void place() {
    bounds = {};
    extraction::place_vertices(
        {places[0].data(), places[1].data(), places[2].data(), places[3].data(), kBatch}, t.data(),
        placement.map, positions.data(), bounds);
  }
  void orient() {
    n_failed = extraction::orient_vertices(
        {{gradients[0].data(), gradients[1].data(), gradients[2].data()},
         {gradients[3].data(), gradients[4].data(), gradients[5].data()}},
        t.data(), kBatch, placement.cofactors, normals.data(), failed.data());
  }

  [[nodiscard]] bool cut_right() const {
    for (std::size_t n = 0; n < kBatch; ++n) {
      if (t[n] != rule.parameter(a[n], b[n])) return false;
    }
    return true;
  }
  [[nodiscard]] bool placed_right() const {
    for (std::size_t n = 0; n < kBatch; ++n) {
      Vec3 p{};
      for (std::size_t c = 0; c < 3; ++c) p[c] = places[c][n];
      Vec3 wanted = placement.map(p);
      const auto axis = static_cast<std::size_t>(places[3][n]);
      for (std::size_t c = 0; c < 3; ++c) {
        wanted[c] += placement.map.m[4 * c + axis] * static_cast<double>(t[n]);
        if (std::abs(positions[3 * n + c] - wanted[c]) > 1e-4) return false;
      }
    }
    return true;
  }
  /// Along the gradient between both ends, and of unit length.
  [[nodiscard]] bool oriented_right() const {
    for (std::size_t n = 0; n < kBatch; ++n) {
      Vec3 wanted{};
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t g = 0; g < 3; ++g) {
          const double lower = gradients[g][n];
          const double upper = gradients[3 + g][n];
          wanted[c] += placement.cofactors[3 * c + g] * (lower + (upper - lower) * t[n]);
        }
      }
      const double length = std::hypot(wanted[0], wanted[1], wanted[2]);
      for (std::size_t c = 0; c < 3; ++c) {
        if (std::abs(normals[3 * n + c] - wanted[c] / length) > 1e-4) return false;
      }
    }
    return n_failed == 0;
  }
};

}  // namespace

void add_vertices() {
  const auto batch = std::make_shared<Batch>();
  add_kernel(
      "cut_edges", "edges", kBatch, [batch] { batch->cut(); },
      [batch] { return batch->cut_right(); });
  add_kernel(
      "place_vertices", "edges", kBatch, [batch] { batch->place(); },
      [batch] { return batch->placed_right(); });
  add_kernel(
      "orient_vertices", "edges", kBatch, [batch] { batch->orient(); },
      [batch] { return batch->oriented_right(); });
}

}  // namespace mc::bench
