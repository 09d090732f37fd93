// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "mc/method.hpp"
#include "mc/pipe.hpp"
#include "pipe/plane_input.hpp"

namespace mc::pipe {

/// What a dense run reads of its input, and the size of that.
struct DensePlanes {
  DensePlanes(const PlaneInput& input, const RunOptions& options);

  /// The volume's planes [k0, k1).
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const { input.read(k0, k1, query, out); }

  PlaneInput input;
  std::optional<SurfaceQuery> query;  ///< unset: all samples are read
  std::uint64_t n_samples = 0;        ///< of a plane of the region
  std::uint64_t plane_bytes = 0;      ///< of a plane of the volume
};

/// Planes of a slab beside one for each of its layers.
std::int32_t shared_planes(const SlabEngine& engine);

}  // namespace mc::pipe
