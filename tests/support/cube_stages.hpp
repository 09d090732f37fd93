// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "mc/process.hpp"

// Cube stages for tests.

namespace mc::test {

/// Leaves cubes as they are.
class Untouched final : public CubeStage {
 public:
  explicit Untouched(std::int32_t n_cells) : n_cells_(n_cells) {}
  [[nodiscard]] std::string_view name() const override { return "untouched"; }
  [[nodiscard]] std::int32_t n_cells() const override { return n_cells_; }
  void apply(MeshCube& /*cube*/) const override {}

 private:
  std::int32_t n_cells_;
};

/// Replaces the four triangles of a vertex that has no more by two, where the seam allows it; then
/// turns the order of the other inner vertices and of the triangles around.
class Unpeg final : public CubeStage {
 public:
  explicit Unpeg(std::int32_t n_cells) : n_cells_(n_cells) {}
  [[nodiscard]] std::string_view name() const override { return "unpeg"; }
  [[nodiscard]] std::int32_t n_cells() const override { return n_cells_; }
  [[nodiscard]] StageBytes bytes() const override { return {0, 64, 64}; }
  [[nodiscard]] bool measures() const override { return true; }

  void apply(MeshCube& cube) const override {
    auto triangles = triangles_of(cube.mesh);
    std::vector<std::vector<std::size_t>> around(cube.mesh.n_vertices());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      for (const std::uint32_t v : triangles[t]) around[v].push_back(t);
    }
    std::vector<bool> is_touched(triangles.size()), is_dropped(cube.mesh.n_vertices());
    for (std::uint32_t v = static_cast<std::uint32_t>(cube.n_seam); v < around.size(); ++v) {
      Ring ring{};
      if (around[v].size() != 4 || !ring_of(v, triangles, around[v], ring)) continue;
      const auto is_free = [&](std::uint32_t w) {
        return std::ranges::none_of(around[w], [&](std::size_t t) { return is_touched[t]; });
      };
      const auto is_inner = [&](std::uint32_t w) {
        return w >= cube.n_seam && around[w].size() > 4;
      };
      if (!std::ranges::all_of(ring, is_free) || !std::ranges::all_of(ring, is_inner) ||
          has_edge(ring[0], ring[2], triangles, around[ring[0]])) {
        continue;
      }
      for (const std::uint32_t w : ring) {
        for (const std::size_t t : around[w]) is_touched[t] = true;
      }
      is_dropped[v] = true;
      triangles[around[v][0]] = {ring[0], ring[1], ring[2]};
      triangles[around[v][1]] = {ring[0], ring[2], ring[3]};
      triangles[around[v][2]] = triangles[around[v][3]] = {};
      ++cube.distances.n;
      cube.distances.sum_squares += 4;
      cube.distances.max = 2;
    }
    write(cube, triangles, is_dropped);
  }

 private:
  using Triangle = std::array<std::uint32_t, 3>;
  using Ring = std::array<std::uint32_t, 4>;

  static std::vector<Triangle> triangles_of(const MeshChunk& mesh) {
    std::vector<Triangle> out;
    for (std::size_t n = 0; n < mesh.indices.size(); n += 3) {
      out.push_back({mesh.indices[n], mesh.indices[n + 1], mesh.indices[n + 2]});
    }
    return out;
  }
  /// The neighbours of a vertex in order, if its triangles form one closed fan.
  static bool ring_of(std::uint32_t vertex, const std::vector<Triangle>& triangles,
                      const std::vector<std::size_t>& around, Ring& ring) {
    std::map<std::uint32_t, std::uint32_t> next;
    for (const std::size_t t : around) {
      const Triangle& of = triangles[t];
      const auto at = static_cast<std::size_t>(std::ranges::find(of, vertex) - of.begin());
      next[of[(at + 1) % 3]] = of[(at + 2) % 3];
    }
    std::uint32_t at = next.begin()->first;
    for (std::uint32_t& neighbour : ring) {
      neighbour = at;
      if (!next.contains(at)) return false;
      at = next[at];
    }
    return next.size() == 4 && at == ring[0];
  }
  static bool has_edge(std::uint32_t a, std::uint32_t b, const std::vector<Triangle>& triangles,
                       const std::vector<std::size_t>& around) {
    return std::ranges::any_of(around, [&](std::size_t t) {
      return std::ranges::count(triangles[t], a) != 0 && std::ranges::count(triangles[t], b) != 0;
    });
  }
  static void write(MeshCube& cube, const std::vector<Triangle>& triangles,
                    const std::vector<bool>& is_dropped) {
    std::vector<std::uint32_t> old;
    for (std::uint32_t v = 0; v < cube.n_seam; ++v) old.push_back(v);
    for (auto v = static_cast<std::uint32_t>(is_dropped.size()); v-- > cube.n_seam;) {
      if (!is_dropped[v]) old.push_back(v);
    }
    std::vector<std::uint32_t> number(is_dropped.size());
    for (std::uint32_t n = 0; n < old.size(); ++n) number[old[n]] = n;
    const auto move = [&](auto& buffer) {
      if (buffer.empty()) return;
      auto from = buffer;
      buffer.clear();
      for (const std::uint32_t v : old) {
        for (std::size_t a = 0; a < 3; ++a) buffer.push_back(from[std::size_t{3} * v + a]);
      }
    };
    move(cube.mesh.positions);
    move(cube.mesh.positions_f64);
    move(cube.mesh.normals);
    cube.mesh.indices.clear();
    for (std::size_t t = triangles.size(); t-- > 0;) {
      if (triangles[t] == Triangle{}) continue;
      for (const std::uint32_t v : triangles[t]) cube.mesh.indices.push_back(number[v]);
    }
  }

  std::int32_t n_cells_;
};

}  // namespace mc::test
