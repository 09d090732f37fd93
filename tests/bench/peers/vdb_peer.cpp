// SPDX-License-Identifier: MIT
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "peer.hpp"

// OpenVDB's volumeToMesh, adaptivity 0, heap kept.
//
//   vdb_peer dense FILE N THREADS          a cube of floats, as the narrow band around value 0
//   vdb_peer sparse FILE.vdb ISO THREADS   the first grid of a file
//   vdb_peer make sphere|fog N FILE.vdb    writes a volume in an index box of N^3

namespace {

using openvdb::Coord;
using openvdb::FloatGrid;

/// The largest step between neighbours on two sides of 0: a band so wide holds every crossed edge.
float widest_crossing(const float* samples, std::ptrdiff_t n) {
  float widest = 0;
  const std::ptrdiff_t steps[3] = {1, n, n * n};
  for (std::ptrdiff_t s = 0; s < n * n * n; ++s) {
    const std::ptrdiff_t at[3] = {s % n, s / n % n, s / (n * n)};
    for (int axis = 0; axis < 3; ++axis) {
      if (at[axis] + 1 == n) continue;
      const float other = samples[s + steps[axis]];
      if ((samples[s] < 0) != (other < 0)) {
        widest = std::max(widest, std::abs(samples[s] - other));
      }
    }
  }
  return widest;
}

/// Only voxels in the band are active, as in a level set: the samples' sign is turned, since
/// OpenVDB's inside is below.
FloatGrid::Ptr narrow_band(float* samples, int n) {
  const float band = widest_crossing(samples, n);
  const auto n_samples = static_cast<std::ptrdiff_t>(n) * n * n;
  std::transform(samples, samples + n_samples, samples,
                 [band](float v) { return std::clamp(-v, -band, band); });
  const openvdb::CoordBBox box(Coord(0), Coord(n - 1));
  const openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(box, samples);
  FloatGrid::Ptr grid = FloatGrid::create(band);
  openvdb::tools::copyFromDense(dense, *grid, 0.0F);
  for (auto it = grid->beginValueOn(); it; ++it) {
    if (std::abs(it.getValue()) >= band) it.setActiveState(false);
  }
  openvdb::tools::pruneLevelSet(grid->tree());
  return grid;
}

/// A ball of wisps that takes three eighths of its box: 51 M active voxels of 512^3.
FloatGrid::Ptr fog(int n) {
  std::vector<float> waves(static_cast<std::size_t>(n));
  std::vector<float> places(waves.size());
  for (int i = 0; i < n; ++i) {
    const double x = 2.0 * i / (n - 1) - 1;
    places[static_cast<std::size_t>(i)] = static_cast<float>(x);
    waves[static_cast<std::size_t>(i)] = static_cast<float>(std::sin(20 * x));
  }
  FloatGrid::Ptr grid = FloatGrid::create(0);
  FloatGrid::Accessor accessor = grid->getAccessor();
  const auto at = [](const std::vector<float>& v, int i) { return v[static_cast<std::size_t>(i)]; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        const float x = at(places, i), y = at(places, j), z = at(places, k);
        const float depth = 0.9F - std::sqrt(x * x + y * y + z * z);
        if (depth <= 0) continue;
        const float wisp = 0.5F + at(waves, i) * at(waves, j) * at(waves, k) / 2;
        accessor.setValue(Coord(i, j, k), std::min(1.0F, 4 * depth) * wisp);
      }
    }
  }
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  return grid;
}

void make(const std::string& kind, int n, const std::string& path) {
  const float radius = 0.475F * static_cast<float>(n);
  const FloatGrid::Ptr grid =
      kind == "fog" ? fog(n)
                    : openvdb::tools::createLevelSetSphere<FloatGrid>(radius, openvdb::Vec3f(0), 1);
  grid->setName(kind);
  openvdb::io::File file(path);
  file.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK);
  file.write({grid});
  std::printf("%llu\n", static_cast<unsigned long long>(grid->activeVoxelCount()));
}

FloatGrid::Ptr read_grid(const std::string& path) {
  openvdb::io::File file(path);
  file.open(false);
  return openvdb::gridPtrCast<FloatGrid>(file.readGrid(file.beginName().gridName()));
}

void serve(const FloatGrid& grid, double iso) {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec4I> quads;
  peer::serve([] {},
              [&] {
                openvdb::tools::volumeToMesh(grid, points, quads, iso);
                return peer::Counts{points.size(), quads.size()};
              });
}

}  // namespace

int main(int argc, char** argv) {
  return peer::guarded([&] {
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (words.size() != 4) {
      throw std::runtime_error("dense FILE N THREADS | sparse FILE ISO THREADS | make KIND N FILE");
    }
    openvdb::initialize();
    if (words[0] == "make") return make(words[1], std::stoi(words[2]), words[3]);
    peer::keep_heap();
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    std::stoul(words[3]));
    if (words[0] == "sparse") return serve(*read_grid(words[1]), std::stod(words[2]));
    const int n = std::stoi(words[2]);
    float* samples = peer::load(words[1], static_cast<std::size_t>(n) * n * n);
    serve(*narrow_band(samples, n), 0);
  });
}
