// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "mc/process.hpp"

// Stages for tests: one of each kind.

namespace mc::test {

/// Moves each vertex by a field of its position in the world.
class Bend final : public MeshStage {
 public:
  [[nodiscard]] std::string_view name() const override { return "bend"; }
  void apply(MeshWindow& window) const override {
    for (std::size_t v = 0; v < window.n_vertices(); ++v) {
      Vec3 p = window.position(v);
      const double along = p[2] + window.origin[2];
      p[0] += 0.75 * std::sin(0.5 * along);
      p[1] += 0.5 * std::cos(p[0] + window.origin[0]);
      window.set_position(v, p);
    }
  }
};

/// Drops the normals; moves nothing.
class Bare final : public MeshStage {
 public:
  [[nodiscard]] std::string_view name() const override { return "bare"; }
  [[nodiscard]] bool moves_vertices() const override { return false; }
  void describe(MeshObject& object) const override { object.has_normals = false; }
  void apply(MeshWindow& window) const override { window.mesh.normals.clear(); }
};

/// Moves each vertex halfway to the mean of its neighbours, again and again. The neighbours are
/// added in the order of the triangles, so that the sum is the same in any window.
class Smooth final : public MeshStage {
 public:
  explicit Smooth(int n_rounds) : n_rounds_(n_rounds) {}
  [[nodiscard]] std::string_view name() const override { return "smooth"; }
  [[nodiscard]] std::int32_t reach() const override { return n_rounds_; }
  [[nodiscard]] StageBytes bytes() const override { return {0, sizeof(Sum), 0}; }
  void apply(MeshWindow& window) const override {
    for (int round = 0; round < n_rounds_; ++round) smooth(window);
  }

 private:
  struct Sum {
    Vec3 at{};
    double n = 0;
  };

  static void smooth(MeshWindow& window) {
    std::vector<Sum> sums(window.n_vertices());
    const auto add = [&](std::uint32_t to, std::uint32_t from) {
      const Vec3 p = window.position(from);
      for (std::size_t a = 0; a < 3; ++a) sums[to].at[a] += p[a];
      ++sums[to].n;
    };
    const Buffer<std::uint32_t>& indices = window.mesh.indices;
    for (std::size_t n = 0; n < indices.size(); n += 3) {
      for (std::size_t s = 0; s < 3; ++s) {
        add(indices[n + s], indices[n + (s + 1) % 3]);
        add(indices[n + (s + 1) % 3], indices[n + s]);
      }
    }
    for (std::size_t v = 0; v < sums.size(); ++v) {
      if (sums[v].n == 0) continue;
      Vec3 p = window.position(v);
      for (std::size_t a = 0; a < 3; ++a) p[a] += 0.5 * (sums[v].at[a] / sums[v].n - p[a]);
      window.set_position(v, p);
    }
  }

  int n_rounds_;
};

/// Drops triangles in slices of the world across x, and vertices that have no triangle then.
class Cut final : public MeshStage {
 public:
  [[nodiscard]] std::string_view name() const override { return "cut"; }
  [[nodiscard]] std::int32_t reach() const override { return 1; }
  [[nodiscard]] bool moves_vertices() const override { return false; }
  [[nodiscard]] bool changes_counts() const override { return true; }
  [[nodiscard]] StageBytes bytes() const override { return {0, 1, 1}; }
  void apply(MeshWindow& window) const override {
    std::vector<std::uint8_t> vertices(window.n_vertices());
    std::vector<std::uint8_t> triangles(window.n_triangles());
    const Buffer<std::uint32_t>& indices = window.mesh.indices;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      double x = 0;
      for (std::size_t c = 0; c < 3; ++c) x += window.position(indices[3 * t + c])[0];
      triangles[t] = std::fmod(std::abs(x / 3 + window.origin[0]), 8) < 5 ? 1 : 0;
      for (std::size_t c = 0; c < 3; ++c) vertices[indices[3 * t + c]] |= triangles[t];
    }
    window.keep(vertices, triangles);
  }
};

/// Drops everything.
class DropAll final : public MeshStage {
 public:
  [[nodiscard]] std::string_view name() const override { return "drop_all"; }
  [[nodiscard]] std::int32_t reach() const override { return 1; }
  [[nodiscard]] bool changes_counts() const override { return true; }
  void apply(MeshWindow& window) const override {
    window.keep(std::vector<std::uint8_t>(window.n_vertices()),
                std::vector<std::uint8_t>(window.n_triangles()));
  }
};

/// Triangles at each vertex.
inline std::vector<std::uint32_t> valences(const MeshWindow& window) {
  std::vector<std::uint32_t> out(window.n_vertices());
  for (const std::uint32_t index : window.mesh.indices) ++out[index];
  return out;
}

/// Moves each vertex by the valences of its later neighbours, some of which lie a layer above:
/// looks up as far as a stage of its reach may.
class Lean final : public MeshStage {
 public:
  [[nodiscard]] std::string_view name() const override { return "lean"; }
  [[nodiscard]] std::int32_t reach() const override { return 1; }
  void apply(MeshWindow& window) const override {
    const std::vector<std::uint32_t> valence = valences(window);
    std::vector<std::uint32_t> sums(window.n_vertices());
    const Buffer<std::uint32_t>& indices = window.mesh.indices;
    for (std::size_t n = 0; n < indices.size(); ++n) {
      const std::uint32_t a = indices[n];
      const std::uint32_t b = indices[n % 3 == 2 ? n - 2 : n + 1];
      sums[std::min(a, b)] += valence[std::max(a, b)];
    }
    for (std::size_t v = 0; v < sums.size(); ++v) {
      Vec3 p = window.position(v);
      p[2] += 0.01 * sums[v];
      window.set_position(v, p);
    }
  }
};

/// Drops triangles by the valences of their vertices, some of which have triangles a layer below:
/// looks down as far as a stage of its reach may.
class Pick final : public MeshStage {
 public:
  [[nodiscard]] std::string_view name() const override { return "pick"; }
  [[nodiscard]] std::int32_t reach() const override { return 1; }
  [[nodiscard]] bool changes_counts() const override { return true; }
  void apply(MeshWindow& window) const override {
    const std::vector<std::uint32_t> valence = valences(window);
    std::vector<std::uint8_t> triangles(window.n_triangles());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const std::uint32_t* corner = &window.mesh.indices[3 * t];
      triangles[t] = (valence[corner[0]] + valence[corner[1]] + valence[corner[2]]) % 3 != 0;
    }
    window.keep(std::vector<std::uint8_t>(window.n_vertices(), 1), triangles);
  }
};

}  // namespace mc::test
