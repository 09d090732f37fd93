// SPDX-License-Identifier: MIT
#include "pipe/dense_planes.hpp"

#include <algorithm>
#include <utility>

#include "base/parallel.hpp"
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

void DensePlanes::read(std::int32_t k0, std::int32_t k1, Slab& out) const {
  copies_ ? copies_->read(k0, k1, out) : input.read(k0, k1, query, out);
}

std::uint64_t DensePlanes::hold_copies(std::uint64_t n_planes, std::uint64_t bytes) {
  // Larger planes leave the caches between copy and use.
  constexpr std::uint64_t kMostBytesAThread = 32U << 20U;
  const std::uint64_t most =
      std::min(bytes, kMostBytesAThread * static_cast<std::uint64_t>(base::thread_count()));
  const std::uint64_t n_bytes = n_planes * plane_bytes;
  const std::uint64_t wanted = n_samples * sample_size(input.volume().type);  // of a plane
  if (n_bytes > most || wanted < plane_bytes / 2) {
    copies_.reset();
  } else if (std::exchange(n_copies_, n_planes) != n_planes || !copies_) {
    copies_ = input.copies(static_cast<std::size_t>(n_planes));
  }
  return copies_ ? n_bytes : 0;
}

std::int32_t shared_planes(const SlabEngine& engine) {
  constexpr std::int32_t kCubesWithGradients = 3;
  const std::int32_t middle = engine.n_layers() / 2;
  const auto [k0, k1] = engine.planes_for(middle, middle + 1);
  return std::max(kCubesWithGradients, k1 - k0 - 1);
}

}  // namespace mc::pipe
