// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "mc/graph.hpp"
#include "support/noise_twins.hpp"

// Value and cellular noises, a sample at a time; of cellular noise all cells that can matter are
// searched.

namespace mc::tests::twin {

inline float signed_unit(std::uint32_t hash) noexcept {
  return static_cast<float>(static_cast<std::int32_t>(hash) >> 8) * 0x1p-23F;
}

/// The value of a lattice point, counted from the cells.
inline float point_value(std::uint32_t seed, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return signed_unit(hash_point(seed, x * kPrimeX, y * kPrimeY, z * kPrimeZ));
}

inline float white(float x, float y, float z, std::uint32_t seed) {
  const float nothing = ((x - x) + (y - y)) + (z - z);  // infinities are held: NaN only for NaN
  const float nan = x != x || y != y || z != z ? nothing : 0.0F;
  return point_value(seed, split(x + 0.5F).cell, split(y + 0.5F).cell, split(z + 0.5F).cell) + nan;
}

inline float value2(float px, float py, std::uint32_t seed) {
  const Split x = split(px);
  const Split y = split(py);
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    return point_value(seed, x.cell + i, y.cell + j, 0);
  };
  const float u = fade(x.rest);
  return lerp(fade(y.rest), lerp(u, at(0, 0), at(1, 0)), lerp(u, at(0, 1), at(1, 1)));
}

inline float value3(float px, float py, float pz, std::uint32_t seed) {
  const Split x = split(px);
  const Split y = split(py);
  const Split z = split(pz);
  const auto line = [&](std::uint32_t j, std::uint32_t k) {
    return lerp(fade(x.rest), point_value(seed, x.cell, y.cell + j, z.cell + k),
                point_value(seed, x.cell + 1, y.cell + j, z.cell + k));
  };
  const float v = fade(y.rest);
  return lerp(fade(z.rest), lerp(v, line(0, 0), line(1, 0)), lerp(v, line(0, 1), line(1, 1)));
}

inline float cubic(float t, const std::array<float, 4>& at) {
  const float tt = t * t;
  const float a = t * (t * (1.0F - 0.5F * t) - 0.5F);
  const float b = 1.0F + tt * (1.5F * t - 2.5F);
  const float c = t * (0.5F + t * (2.0F - 1.5F * t));
  const float d = tt * (0.5F * t - 0.5F);
  return ((a * at[0] + b * at[1]) + c * at[2]) + d * at[3];
}

inline float cubic_plane(const Split& x, const Split& y, std::uint32_t z, std::uint32_t seed) {
  std::array<float, 4> lines{};
  for (std::uint32_t j = 0; j < 4; ++j) {
    std::array<float, 4> points{};
    for (std::uint32_t i = 0; i < 4; ++i) {
      points[i] = point_value(seed, x.cell + i - 1, y.cell + j - 1, z);
    }
    lines[j] = cubic(x.rest, points);
  }
  return cubic(y.rest, lines);
}

inline float value_cubic2(float px, float py, std::uint32_t seed) {
  return cubic_plane(split(px), split(py), 0, seed) * 0.64F;
}

inline float value_cubic3(float px, float py, float pz, std::uint32_t seed) {
  const Split z = split(pz);
  std::array<float, 4> planes{};
  for (std::uint32_t k = 0; k < 4; ++k) {
    planes[k] = cubic_plane(split(px), split(py), z.cell + k - 1, seed);
  }
  return cubic(z.rest, planes) * 0.512F;
}

/// Cellular noise; in two dimensions without z. Of equally near points the first counts.
inline float cellular(const Node& node, bool flat, float px, float py, float pz,
                      std::uint32_t seed) {
  const Split at[3] = {split(px), split(py), split(pz)};
  const auto measured = [&](std::size_t axis, int cell, std::uint32_t bits) {
    const float offset = static_cast<float>(static_cast<std::int32_t>(bits)) * 0x1p-32F;
    const float d = ((static_cast<float>(cell) + 0.5F) - at[axis].rest) + offset * node.numbers[1];
    return node.cell_metric == CellMetric::euclidean ? d * d : std::abs(d);
  };
  const auto join = [&](float a, float b) {
    return node.cell_metric == CellMetric::chebyshev ? std::max(a, b) : a + b;
  };
  float first = 0x1p60F;
  float second = 0x1p60F;
  std::uint32_t owner = 0;
  constexpr int kOffsets[] = {0, -1, 1, -2, 2, -3, 3};
  for (const int k : kOffsets) {
    if (flat && k != 0) break;
    for (const int j : kOffsets) {
      for (const int i : kOffsets) {
        const std::uint32_t hash =
            hash_point(seed, (at[0].cell + static_cast<std::uint32_t>(i)) * kPrimeX,
                       (at[1].cell + static_cast<std::uint32_t>(j)) * kPrimeY,
                       flat ? 0U : (at[2].cell + static_cast<std::uint32_t>(k)) * kPrimeZ);
        float d = measured(1, j, hash << 11);
        if (!flat) d = join(d, measured(2, k, hash << 22));
        d = join(d, measured(0, i, hash));
        second = std::min(second, std::max(first, d));
        if (d < first) owner = hash;
        first = std::min(first, d);
      }
    }
  }
  if (node.cell_return == CellReturn::value) {
    return signed_unit(hash_point(owner, 0, 0, 0));
  }
  if (node.cell_metric == CellMetric::euclidean) {
    first = std::sqrt(first);
    second = std::sqrt(second);
  }
  return node.cell_return == CellReturn::f1   ? first
         : node.cell_return == CellReturn::f2 ? second
                                              : second - first;
}

}  // namespace mc::tests::twin
