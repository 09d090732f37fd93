// SPDX-License-Identifier: MIT
#include <array>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>
#include <string_view>

#include "boxes/boxes.hpp"
#include "dots/dots.hpp"
#include "mc/convert.hpp"
#include "mc/method.hpp"
#include "off/off.hpp"
#include "smooth/smooth.hpp"

namespace {

void print(const mc::ConvertReport& report, std::string_view how) {
  std::ifstream file("two.off");
  std::string magic;
  std::size_t n_vertices = 0, n_triangles = 0;
  file >> magic >> n_vertices >> n_triangles;
  std::cout << report.volume->format << " to " << report.format << " by " << how << ", "
            << report.surface->isos[0].reason << ": " << magic << ' ' << n_vertices << " vertices, "
            << n_triangles << " triangles\n";
}

}  // namespace

// A source, a sink, a method and a stage that the library does not know take part in convert().
int main() {
  std::ofstream("two.txt") << "dots 5 5 5\n1 1 1 1\n3 3 3 1\n";
  mc::ConvertOptions options;
  const std::array<const mc::SourceFormat*, 1> sources{&kDotsFormat};
  const std::array<const mc::SinkFormat*, 1> sinks{&kOffFormat};
  options.source.further_formats = sources;
  options.sink.further_formats = sinks;
  options.sink.force = true;
  for (const mc::Method* method : {&mc::cubes_method(), &kBoxesMethod}) {
    options.extract.method = method;
    print(mc::convert("two.txt", "two.off", options), method->name);
  }
  const Smooth smooth;
  const std::array<const mc::MeshStage*, 1> stages{&smooth};
  options.extract.method = nullptr;
  options.stages = stages;
  const mc::ConvertReport report = mc::convert("two.txt", "two.off", options);
  print(report, smooth.name());
  std::cout << "from " << report.totals[0].bounds.lo[0] << " to " << report.totals[0].bounds.hi[0]
            << '\n';
  options.stages = {};
  // Vertices carry what another volume says where they are: here, how dense the dots are.
  const mc::Source dots =
      mc::open_source(std::array<std::string, 1>{"two.txt"}, options.source, mc::silent_progress());
  options.attributes = {{"density", &dots.reader}};
  options.sink.ascii = true;
  mc::convert("two.txt", "two.ply", options);
  std::ifstream ply("two.ply");
  for (std::string line; std::getline(ply, line);) {
    if (line == "property float density") std::cout << "with density\n";
  }
  std::remove("two.ply");
  std::remove("two.txt");
  std::remove("two.off");
}
