// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "mc/mesh.hpp"

// A second opinion on meshes, written for being plainly right: maps of everything, no cleverness.
// It shares no code with check_mesh.

namespace mc::test {

class MeshOracle {
 public:
  explicit MeshOracle(const Mesh& mesh);

  [[nodiscard]] bool closed() const { return report_.boundary_edges == 0; }
  /// No edge with more than two triangles, one fan around each vertex.
  [[nodiscard]] bool manifold() const {
    return report_.nonmanifold_edges == 0 && report_.nonmanifold_vertices == 0;
  }
  [[nodiscard]] bool oriented() const { return report_.misoriented_edges == 0; }
  [[nodiscard]] std::int64_t euler() const { return report_.euler; }
  [[nodiscard]] double volume() const { return report_.volume; }
  [[nodiscard]] double area() const { return report_.area; }
  /// Everything that check_mesh counts.
  [[nodiscard]] const MeshReport& report() const { return report_; }

 private:
  using Triangle = std::array<std::uint64_t, 3>;

  void look_at_vertices(const Mesh& mesh);
  void sort_out_triangles(const Mesh& mesh);
  void measure(const Mesh& mesh);
  void count_edges();
  void count_fans();
  void count_components();

  std::vector<Triangle> proper_;  // in range, three different vertices
  std::map<std::uint64_t, std::vector<Triangle>> around_;
  MeshReport report_;
};

}  // namespace mc::test
