// SPDX-License-Identifier: MIT
#include "pipe/dense_planes.hpp"

#include <algorithm>

#include "extract/bits/threshold.hpp"

namespace mc::pipe {

DensePlanes::DensePlanes(const PlaneInput& from, const RunOptions& options) : input(from) {
  const Volume& volume = input.volume();
  const IndexBox box = options.extract.region.value_or(volume.lattice.box);
  n_samples = static_cast<std::uint64_t>(box.extent(0) * box.extent(1));
  if (options.skip) {
    query = {extraction::effective_iso(volume.type, options.extract.iso), box,
             options.extract.border != Border::open};
  }
  plane_bytes = static_cast<std::uint64_t>(volume.lattice.box.extent(0)) *
                static_cast<std::uint64_t>(volume.lattice.box.extent(1)) * sample_size(volume.type);
}

std::int32_t shared_planes(const SlabEngine& engine) {
  constexpr std::int32_t kCubesWithGradients = 3;
  const std::int32_t middle = engine.n_layers() / 2;
  const auto [k0, k1] = engine.planes_for(middle, middle + 1);
  return std::max(kCubesWithGradients, k1 - k0 - 1);
}

}  // namespace mc::pipe
