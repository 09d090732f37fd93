// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "mc/method.hpp"
#include "mc/pipe.hpp"
#include "pipe/plane_input.hpp"

namespace mc::pipe {

/// What a dense run reads of its input, and the size of that.
struct DensePlanes {
  DensePlanes(const PlaneInput& input, const RunOptions& options);

  /// The volume's planes [k0, k1).
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const;
  /// Decides whether planes of a file are copied: if that is faster, and `n_planes` of them, which
  /// are in use at once, take at most `bytes`. Returns the bytes of the copies; 0 if none are made.
  std::uint64_t hold_copies(std::uint64_t n_planes, std::uint64_t bytes);

  PlaneInput input;
  std::optional<SurfaceQuery> query;  ///< unset: all samples are read
  std::uint64_t n_samples = 0;        ///< of a plane of the region
  std::uint64_t plane_bytes = 0;      ///< of a plane of the volume

 private:
  std::unique_ptr<SlabReader> copies_;  ///< null: none are made
  std::uint64_t n_copies_ = 0;
};

/// Planes of a slab beside one for each of its layers.
std::int32_t shared_planes(const SlabEngine& engine);

}  // namespace mc::pipe
