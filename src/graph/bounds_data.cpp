// SPDX-License-Identifier: MIT
#include "graph/bounds_data.hpp"

#include <algorithm>
#include <cmath>

#include "graph/interval_math.hpp"
#include "graph/volume_place.hpp"

namespace mc::graph {

namespace {

constexpr float kRounding = 1e-5F;
constexpr float kMostValue = 1e30F;  // far from overflow on the way

/// Indices from the first to the last that a place along one axis may be made of.
struct Reach {
  std::int32_t first;
  std::int32_t last;

  [[nodiscard]] std::int64_t count() const { return std::int64_t{last} - first + 1; }
};

/// Sums of products round upwards and downwards as their terms do, so that the ends of the
/// coordinates give the ends of all places.
Reach reach_of(const double* row, std::int32_t n, const Interval (&at)[3]) {
  double low[3];
  double high[3];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = row[axis] < 0 ? at[axis].hi : at[axis].lo;
    high[axis] = row[axis] < 0 ? at[axis].lo : at[axis].hi;
  }
  const RowSum from = row_sum(row, low[0], low[1], low[2]);
  const RowSum to = row_sum(row, high[0], high[1], high[2]);
  const double blur = 2 * (from.blur + to.blur);  // more than that of any place between
  const auto held = [&](double v) {
    return static_cast<std::int32_t>(std::clamp(v, -1.0, static_cast<double>(n)));
  };
  return {held(std::floor(from.at - blur)), held(std::floor(to.at + blur) + 1)};
}

Interval between_samples(const DataUse& use, const Reach (&reach)[3]) {
  float least = sample_at(use, {reach[0].first, reach[1].first, reach[2].first});
  float greatest = least;
  for (std::int32_t k = reach[2].first; k <= reach[2].last; ++k) {
    for (std::int32_t j = reach[1].first; j <= reach[1].last; ++j) {
      for (std::int32_t i = reach[0].first; i <= reach[0].last; ++i) {
        const float v = sample_at(use, {i, j, k});
        if (!std::isfinite(v)) return kUnknown;
        least = std::min(least, v);
        greatest = std::max(greatest, v);
      }
    }
  }
  return between(least, greatest);
}

}  // namespace

Interval heightmap_bounds(const Instruction& instruction, const Interval (&at)[3]) {
  const auto& p = instruction.p;
  const DataUse& use = *instruction.data;
  const Interval u = monotone(at[0], [&](float v) { return (v - p[0]) * p[2]; });
  const Interval v = monotone(at[1], [&](float w) { return (w - p[1]) * p[3]; });
  const Interval pixels = between(use.least, use.greatest);
  if (!u.known() || !v.known() || !pixels.known() || !(size_of(pixels) < kMostValue)) {
    return kUnknown;
  }
  const float beyond = use.filter == Filter::cubic ? 0.3F * (pixels.hi - pixels.lo) : 0.0F;
  return product(widened(pixels, beyond + kRounding * size_of(pixels)), {p[4], p[4]});
}

Interval volume_bounds(const Instruction& instruction, const Interval (&at)[3]) {
  constexpr std::int64_t kFew = 4096;
  const DataUse& use = *instruction.data;
  const SampledVolume& volume = *use.volume;
  Reach reach[3];
  std::int64_t count = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    reach[axis] = reach_of(&volume.to_index.m[4 * axis], volume.dims[axis], at);
    count = std::min(count, kFew + 1) * reach[axis].count();
  }
  const Interval samples =
      count <= kFew ? between_samples(use, reach) : between(use.least, use.greatest);
  if (!samples.known() || !(size_of(samples) < kMostValue)) return kUnknown;
  return use.filter == Filter::nearest ? samples : widened(samples, kRounding * size_of(samples));
}

}  // namespace mc::graph
