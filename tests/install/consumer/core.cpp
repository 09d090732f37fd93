// SPDX-License-Identifier: MIT
#include <array>
#include <iostream>

#include "mc/extract.hpp"

// One sample inside, 26 around it outside: an octahedron.
int main() {
  std::array<float, 27> samples{};
  samples[13] = 1;
  const mc::Mesh mesh =
      mc::extract(mc::View3<const float>(samples.data(), {3, 3, 3}), {.iso = 0.5});
  std::cout << mesh.n_vertices() << " vertices, " << mesh.n_triangles() << " triangles\n";
}
