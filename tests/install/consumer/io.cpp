// SPDX-License-Identifier: MIT
#include <array>
#include <cstdio>
#include <iostream>
#include <string>

#include "mc/convert.hpp"

// One sample inside, 26 around it outside: an octahedron, by way of two files.
int main() {
  const std::array<float, 27> samples = [] {
    std::array<float, 27> one{};
    one[13] = 1;
    return one;
  }();
  const std::string path = WITH_VDB != 0 ? "consumer.vdb" : "consumer.nrrd";
  mc::Volume volume;
  volume.lattice.box = {{0, 0, 0}, {2, 2, 2}};
  mc::Slab slab;
  for (std::size_t k = 0; k < 3; ++k) {
    slab.planes.push_back(reinterpret_cast<const std::byte*>(samples.data() + 9 * k));
  }
  slab.row_stride_bytes = 3 * sizeof(float);
  const auto sink = mc::open_volume_sink(path, {.force = true});
  sink->begin(volume);
  sink->write(slab);
  sink->finish();

  mc::ConvertOptions options;
  options.surface.isos = {{.value = 0.5}};
  options.sink.force = true;
  const mc::ConvertReport report = mc::convert(path, "consumer.ply", options);
  std::remove(path.c_str());
  std::cout << report.totals[0].n_vertices << " vertices, " << report.totals[0].n_triangles
            << " triangles\n";
}
