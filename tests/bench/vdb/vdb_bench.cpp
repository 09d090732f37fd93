// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "mc/pipe.hpp"
#include "mc/source.hpp"
#include "mesh/memory_sink.hpp"

// Loading VDB files by mc and by OpenVDB's own io::File, alternately in one process. The file is in
// the page cache.
//
//   mc_vdb_bench make KIND COMPRESSION SIZE FILE
//       KIND fog or sphere; COMPRESSION none, zip, blosc
//   mc_vdb_bench load RUNS THREADS FILE
//       one line: medians in ms of both and of mc's extraction into memory; active samples

namespace {

using Clock = std::chrono::steady_clock;

/// A ball of fog with waves in it, so that it does not compress to nothing.
openvdb::FloatGrid::Ptr make_fog(int size) {
  auto grid = openvdb::FloatGrid::create(0);
  const double radius = size / 2.0;
  using Leaf = openvdb::FloatTree::LeafNodeType;
  std::vector<openvdb::Coord> origins;
  for (int x = -size / 2; x < size / 2; x += 8) {
    for (int y = -size / 2; y < size / 2; y += 8) {
      for (int z = -size / 2; z < size / 2; z += 8) {
        if (std::hypot(x + 4, y + 4, z + 4) < radius + 8)
          origins.emplace_back(x & ~7, y & ~7, z & ~7);
      }
    }
  }
  for (const openvdb::Coord& origin : origins) {
    auto* leaf = new Leaf(origin, 0);
    for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
      const openvdb::Coord at = leaf->offsetToGlobalCoord(n);
      const double d = radius - std::hypot(at.x(), at.y(), at.z());
      if (d <= 0) continue;
      const double waves =
          std::sin(at.x() * 0.11) * std::sin(at.y() * 0.13) * std::sin(at.z() * 0.17);
      leaf->setValueOn(n, static_cast<float>(
                              std::round(512 * std::min(1.0, d / 40) * (0.6 + 0.4 * waves)) / 512));
    }
    grid->tree().addLeaf(leaf);
  }
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setName("density");
  return grid;
}

int make(const std::string& kind, const std::string& compression, int size,
         const std::string& path) {
  openvdb::initialize();
  openvdb::FloatGrid::Ptr grid =
      kind == "fog" ? make_fog(size)
                    : openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
                          static_cast<float>(size) * 0.45F, openvdb::Vec3f(0), 1.F);
  openvdb::io::File file(path);
  const std::uint32_t packed = compression == "zip"     ? openvdb::io::COMPRESS_ZIP
                               : compression == "blosc" ? openvdb::io::COMPRESS_BLOSC
                                                        : openvdb::io::COMPRESS_NONE;
  file.setCompression(packed | openvdb::io::COMPRESS_ACTIVE_MASK);
  file.write({grid});
  return 0;
}

double ms_of(const std::function<void()>& run) {
  const Clock::time_point start = Clock::now();
  run();
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

std::uint64_t load_by_openvdb(const std::string& path) {
  openvdb::io::File file(path);
  file.open(/*delayLoad=*/false);
  const openvdb::GridBase::Ptr grid = file.readGrid(file.beginName().gridName());
  return grid->activeVoxelCount();
}

std::uint64_t load_by_mc(const std::string& path) {
  const mc::Source source =
      mc::open_source(std::vector<std::string>{path}, {}, mc::silent_progress());
  return mc::volume_of(source.reader).n_active.value_or(0);
}

/// mc's extraction of a loaded file, with normals, into a mesh whose memory is warm.
class Extraction {
 public:
  explicit Extraction(const std::string& path)
      : source_(mc::open_source(std::vector<std::string>{path}, {}, mc::silent_progress())) {
    const bool is_fog = mc::volume_of(source_.reader).cls == mc::VolumeClass::fog;
    options_.extract.iso = is_fog ? 0.5 : 0;
    options_.extract.inside = is_fog ? mc::Inside::above : mc::Inside::below;
  }
  void run() {
    mc::mesh::MemorySink sink;
    sink.start(mesh_);
    mc::run(source_.reader, options_, false, sink, mc::silent_progress(), {});
    sink.finish();
  }

 private:
  mc::Source source_;
  mc::RunOptions options_;
  mc::Mesh mesh_;
};

int load(int n_runs, int n_threads, const std::string& path) {
  openvdb::initialize();
  const mc::base::ThreadLimit limit(n_threads);
  std::vector<double> ours;
  std::vector<double> theirs;
  std::vector<double> extracted;
  std::uint64_t n_ours = load_by_mc(path);
  std::uint64_t n_theirs = load_by_openvdb(path);
  if (n_ours != n_theirs) {
    fmt::print(stderr, "{}: {} active samples, but OpenVDB reads {}\n", path, n_ours, n_theirs);
    return 1;
  }
  Extraction extraction(path);
  extraction.run();
  for (int n = 0; n < n_runs; ++n) {
    ours.push_back(ms_of([&] { load_by_mc(path); }));
    theirs.push_back(ms_of([&] { load_by_openvdb(path); }));
    extracted.push_back(ms_of([&] { extraction.run(); }));
  }
  fmt::print("{:.1f} {:.1f} {:.1f} {}\n", median(ours), median(theirs), median(extracted), n_ours);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> args(argv + 1, argv + argc);
  if (args.size() == 5 && args[0] == "make") {
    return make(args[1], args[2], std::atoi(args[3].c_str()), args[4]);
  }
  if (args.size() == 4 && args[0] == "load") {
    return load(std::atoi(args[1].c_str()), std::atoi(args[2].c_str()), args[3]);
  }
  fmt::print(stderr,
             "usage: mc_vdb_bench make KIND COMPRESSION SIZE FILE | load RUNS THREADS FILE\n");
  return 2;
}
