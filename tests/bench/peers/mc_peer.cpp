// SPDX-License-Identifier: MIT
#include <fstream>

#include "base/parallel.hpp"
#include "cli/bench/bench_bandwidth.hpp"
#include "cli/bench/bench_field.hpp"
#include "cli/bench/bench_surface.hpp"
#include "mc/pipe.hpp"
#include "mc/source.hpp"
#include "peer.hpp"
#include "support/mesh_collector.hpp"

// Our side of scripts/bench: the library call into a warm mesh, and the fields for everyone.
//
//   mc_peer fields NAME N PERIODS FILE               writes a cube of floats; periods: the gyroid's
//   mc_peer dense FILE N THREADS none|gradient
//   mc_peer sparse FILE.vdb ISO THREADS
//   mc_peer read FILE N THREADS                      only reads the samples: what memory allows

namespace mc {
namespace {

using Words = std::vector<std::string>;

void write_field(const Words& words) {
  const cli::BenchVolume volume =
      cli::make_bench_volume(words[1], std::stoi(words[2]), SampleType::f32, std::stod(words[3]));
  std::ofstream file(words[4], std::ios::binary);
  file.write(reinterpret_cast<const char*>(volume.samples.data()),
             static_cast<std::streamsize>(volume.samples.size()));
  if (!file.flush()) throw std::runtime_error(words[4] + ": cannot write");
}

cli::BenchVolume load(const std::string& path, std::int32_t n) {
  const auto side = static_cast<std::size_t>(n);
  const std::size_t n_samples = side * side * side;
  cli::BenchVolume volume{SampleType::f32, n, cli::BenchArray(n_samples * sizeof(float))};
  peer::load(path, reinterpret_cast<float*>(volume.samples.data()), n_samples);
  return volume;
}

void serve_reading(const Words& words) {
  const cli::BenchVolume volume = load(words[1], std::stoi(words[2]));
  const base::ThreadLimit limit(std::stoi(words[3]));
  peer::serve([] {},
              [&] {
                cli::read_memory(volume.samples.data(), volume.samples.size());
                return peer::Counts{};
              });
}

void serve_dense(const Words& words) {
  const cli::BenchVolume volume = load(words[1], std::stoi(words[2]));
  const base::ThreadLimit limit(std::stoi(words[3]));
  cli::BenchSurface surface(volume, words[4] == "none" ? Normals::none : Normals::gradient);
  surface.extract();
  if (const std::string fault = cli::fault_of(volume, surface.mesh()); !fault.empty()) {
    throw std::runtime_error(fault);
  }
  peer::serve([] {},
              [&] {
                surface.extract();
                return peer::Counts{surface.mesh().n_vertices(), surface.mesh().n_triangles()};
              });
}

void serve_sparse(const Words& words) {
  const Source source = open_source(Words{words[1]}, {}, silent_progress());
  const base::ThreadLimit limit(std::stoi(words[3]));
  RunOptions options;
  options.extract.iso = std::stod(words[2]);
  options.extract.normals = Normals::none;
  test::Collected out;
  test::CollectingSink sink(out);
  peer::serve([&] { out.mesh.clear(); },
              [&] {
                const MeshTotals totals =
                    run(source.reader, options, false, sink, silent_progress(), {});
                return peer::Counts{totals.n_vertices, totals.n_triangles};
              });
}

}  // namespace
}  // namespace mc

int main(int argc, char** argv) {
  return peer::guarded([&] {
    const mc::Words words(argv + 1, argv + argc);
    if (words.size() == 5 && words[0] == "fields") return mc::write_field(words);
    if (words.size() == 5 && words[0] == "dense") return mc::serve_dense(words);
    if (words.size() == 4 && words[0] == "sparse") return mc::serve_sparse(words);
    if (words.size() == 4 && words[0] == "read") return mc::serve_reading(words);
    throw std::runtime_error(
        "fields NAME N PERIODS FILE | dense FILE N THREADS none|gradient | "
        "sparse FILE ISO THREADS | read FILE N THREADS");
  });
}
