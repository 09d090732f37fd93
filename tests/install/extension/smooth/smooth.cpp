// SPDX-License-Identifier: MIT
#include "smooth/smooth.hpp"

#include <array>
#include <cstddef>
#include <vector>

// Neighbours are added in the order of the triangles. That order is the same in every window, and
// so is the rounding of the sums.

void Smooth::apply(mc::MeshWindow& window) const {
  std::vector<std::array<double, 4>> sums(window.n_vertices());  // of positions, and their number
  const auto add = [&](std::size_t to, std::size_t from) {
    const mc::Vec3 p = window.position(from);
    for (std::size_t a = 0; a < 3; ++a) sums[to][a] += p[a];
    sums[to][3] += 1;
  };
  const auto& indices = window.mesh.indices;
  for (std::size_t n = 0; n < indices.size(); n += 3) {
    for (std::size_t s = 0; s < 3; ++s) {
      add(indices[n + s], indices[n + (s + 1) % 3]);
      add(indices[n + (s + 1) % 3], indices[n + s]);
    }
  }
  for (std::size_t v = 0; v < sums.size(); ++v) {
    if (sums[v][3] == 0) continue;
    mc::Vec3 p = window.position(v);
    for (std::size_t a = 0; a < 3; ++a) p[a] += 0.5 * (sums[v][a] / sums[v][3] - p[a]);
    window.set_position(v, p);
  }
  window.mesh.normals.clear();
}
