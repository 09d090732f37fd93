// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "graph/program.hpp"

// Places among the samples of a volume, and the samples there: what its rows and its bounds share.

namespace mc::graph {

/// A sum of coordinates and a row of a matrix, in double; and how far it may be off, because the
/// coordinates were rounded to float32 on their way here.
struct RowSum {
  double at;
  double blur;
};

inline RowSum row_sum(const double* row, double x, double y, double z) noexcept {
  const double u = row[0] * x;
  const double v = row[1] * y;
  const double w = row[2] * z;
  const double size = ((std::abs(u) + std::abs(v)) + std::abs(w)) + std::abs(row[3]);
  return {((u + v) + w) + row[3], size * 0x1p-23};
}

/// The sample at an index of the endless lattice.
inline float sample_at(const DataUse& use, const Index3& at) noexcept {
  const SampledVolume& volume = *use.volume;
  std::size_t place = 0;
  for (std::size_t axis = 3; axis-- > 0;) {
    const std::int32_t n = volume.dims[axis];
    const std::int32_t held = at[axis] < 0 ? 0 : (at[axis] < n ? at[axis] : n - 1);
    if (held != at[axis] && use.outside) return *use.outside;
    place = place * static_cast<std::size_t>(n) + static_cast<std::size_t>(held);
  }
  return volume.samples[place];
}

}  // namespace mc::graph
