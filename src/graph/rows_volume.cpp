// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "graph/rows.hpp"
#include "graph/volume_place.hpp"

// Volumes read by nodes: trilinear between samples, or the nearest one. Places are worked out in
// double. One that is no farther from a sample than the rounding of its coordinates is the
// sample's: a volume that is read at its own samples gives them back, bit by bit.

namespace mc::graph {

namespace {

/// Between sample `lower` and the next one, `t` of the way.
struct Place {
  std::int32_t lower;
  float t;
};

Place place_of(const RowSum& sum, std::int32_t n, Filter filter) noexcept {
  const double nearest = std::floor(sum.at + 0.5);
  const bool on_sample = filter == Filter::nearest || std::abs(sum.at - nearest) <= sum.blur;
  // All that lies beyond the first sample outside is like it.
  const double at = std::clamp(on_sample ? nearest : sum.at, -1.0, static_cast<double>(n));
  const double lower = std::floor(at);
  return {static_cast<std::int32_t>(lower), static_cast<float>(at - lower)};
}

/// On a sample it is that sample, whatever the next one: NaN, an infinity, a zero of another sign.
float mixed(float a, float b, float t) noexcept { return t == 0.0F ? a : a + (b - a) * t; }

float interpolated(const DataUse& use, const std::array<Place, 3>& at) noexcept {
  std::array<float, 2> over_k{};
  for (std::int32_t k = 0; k < 2; ++k) {
    std::array<float, 2> over_j{};
    for (std::int32_t j = 0; j < 2; ++j) {
      const Index3 corner{at[0].lower, at[1].lower + j, at[2].lower + k};
      const float a = sample_at(use, corner);
      const float b = sample_at(use, {corner[0] + 1, corner[1], corner[2]});
      over_j[static_cast<std::size_t>(j)] = mixed(a, b, at[0].t);
    }
    over_k[static_cast<std::size_t>(k)] = mixed(over_j[0], over_j[1], at[1].t);
  }
  return mixed(over_k[0], over_k[1], at[2].t);
}

}  // namespace

void volume_row(const Instruction& instruction, Row x, Row y, Row z, std::size_t n,
                OutRow out) noexcept {
  const DataUse& use = *instruction.data;
  const SampledVolume& volume = *use.volume;
  for (std::size_t i = 0; i < n; ++i) {
    // NaN where a coordinate is not finite, else 0.
    const float unknown = ((x[i] - x[i]) + (y[i] - y[i])) + (z[i] - z[i]);
    if (unknown != 0.0F) {
      out[i] = unknown;
      continue;
    }
    std::array<Place, 3> at{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double* row = &volume.to_index.m[4 * axis];
      at[axis] = place_of(row_sum(row, x[i], y[i], z[i]), volume.dims[axis], use.filter);
    }
    out[i] = interpolated(use, at);
  }
}

}  // namespace mc::graph
