// SPDX-License-Identifier: MIT
#include <array>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "mc/extract.hpp"
#include "mc/sink.hpp"
#include "mc/source.hpp"

// One sample inside, 26 around it outside: an octahedron, by way of a file.
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

  const mc::Source source =
      mc::open_source(std::vector<std::string>{path}, {}, mc::silent_progress());
  std::remove(path.c_str());
  std::unique_ptr<mc::SlabReader> view;
  if (const auto* sparse = std::get_if<std::unique_ptr<mc::LeafReader>>(&source.reader)) {
    view = mc::dense_view(**sparse, volume.lattice.box);
  }
  const mc::SlabReader& dense =
      view ? *view : *std::get<std::unique_ptr<mc::SlabReader>>(source.reader);
  mc::Slab back;
  dense.read(0, 3, back);
  std::array<float, 27> read{};
  for (std::size_t row = 0; row < 9; ++row) {
    std::memcpy(read.data() + 3 * row, back.planes[row / 3] + row % 3 * back.row_stride_bytes,
                3 * sizeof(float));
  }
  const mc::Mesh mesh = mc::extract(mc::View3<const float>(read.data(), {3, 3, 3}), {.iso = 0.5});
  std::cout << mesh.positions.size() << " vertices, " << mesh.triangles.size() << " triangles\n";
}
