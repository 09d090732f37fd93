// SPDX-License-Identifier: MIT
#include <array>
#include <cstdint>

#include "graph/float_math.hpp"
#include "graph/rows.hpp"

// Nodes that read pictures. Texture rules: a picture of n pixels covers [0, n], the centre of pixel
// i is at i + 1/2. Source   Catmull and Rom, "A class of local interpolating splines", 1974 (the
// cubic filter).

namespace mc::graph {

namespace {

/// Brings a finite place near [0, n] without changing what lies there.
float near_picture(float at, float n, Wrap wrap) noexcept {
  if (wrap == Wrap::clamp) {
    return clamped(at, -2.0F, n + 1.0F);
  }
  const float period = wrap == Wrap::repeat ? n : 2.0F * n;
  return clamped(at - period * exact_floor(at / period), 0.0F, period);
}

/// The pixel that stands at place i, which may lie beyond the edge.
std::int32_t pixel_at(std::int32_t i, std::int32_t n, Wrap wrap) noexcept {
  if (wrap == Wrap::clamp) {
    return i < 0 ? 0 : (i < n ? i : n - 1);
  }
  const std::int32_t period = wrap == Wrap::repeat ? n : 2 * n;
  const std::int32_t rest = i % period;
  const std::int32_t m = rest < 0 ? rest + period : rest;
  return m < n ? m : period - 1 - m;
}

/// The pixels along one axis that a value is made of, and their weights.
template <int kTaps>
struct Taps {
  std::array<std::int32_t, kTaps> pixel{};
  std::array<float, kTaps> weight{};  // linear: the second is t, the first is not looked at

  Taps(float at, std::int32_t n, Wrap wrap) noexcept {
    constexpr int kFirst = kTaps == 4 ? 1 : 0;  // taps before the one at or below `at`
    const float centred = near_picture(at, static_cast<float>(n), wrap) - 0.5F;
    const float base = exact_floor(kTaps == 1 ? centred + 0.5F : centred);
    const float t = centred - base;
    for (int tap = 0; tap < kTaps; ++tap) {
      pixel[static_cast<std::size_t>(tap)] =
          pixel_at(static_cast<std::int32_t>(base) + tap - kFirst, n, wrap);
    }
    if constexpr (kTaps == 2) {
      weight = {1.0F, t};
    } else if constexpr (kTaps == 4) {
      weight = {((-0.5F * t + 1.0F) * t - 0.5F) * t, (1.5F * t - 2.5F) * t * t + 1.0F,
                ((-1.5F * t + 2.0F) * t + 0.5F) * t, (0.5F * t - 0.5F) * t * t};
    }
  }

  [[nodiscard]] float mixed(const std::array<float, kTaps>& v) const noexcept {
    if constexpr (kTaps == 1) {
      return v[0];
    } else if constexpr (kTaps == 2) {
      return v[0] + (v[1] - v[0]) * weight[1];
    } else {
      return ((v[0] * weight[0] + v[1] * weight[1]) + v[2] * weight[2]) + v[3] * weight[3];
    }
  }
};

template <int kTaps>
void picture_row(const Instruction& instruction, Row u, Row v, std::size_t n, OutRow out) noexcept {
  const auto& p = instruction.p;
  const DataUse& use = *instruction.data;
  const Raster& raster = *use.raster;
  const float* pixels = raster.samples.data();
  for (std::size_t i = 0; i < n; ++i) {
    const float at_u = (u[i] - p[0]) * p[2];
    const float at_v = (v[i] - p[1]) * p[3];
    const float unknown = (at_u - at_u) + (at_v - at_v);  // NaN where a place is not finite, else 0
    const bool good = unknown == 0.0F;
    const Taps<kTaps> columns(good ? at_u : 0.0F, raster.width, use.wrap);
    const Taps<kTaps> rows(good ? at_v : 0.0F, raster.height, use.wrap);
    std::array<float, kTaps> along{};
    for (std::size_t r = 0; r < kTaps; ++r) {
      const float* row = pixels + std::ptrdiff_t{rows.pixel[r]} * raster.width;
      std::array<float, kTaps> values{};
      for (std::size_t c = 0; c < kTaps; ++c) {
        values[c] = row[columns.pixel[c]];
      }
      along[r] = columns.mixed(values);
    }
    out[i] = good ? p[4] * rows.mixed(along) : unknown;
  }
}

}  // namespace

void heightmap_row(const Instruction& instruction, Row u, Row v, Row /*unused*/, std::size_t n,
                   OutRow out) noexcept {
  switch (instruction.data->filter) {
    case Filter::nearest:
      return picture_row<1>(instruction, u, v, n, out);
    case Filter::linear:
      return picture_row<2>(instruction, u, v, n, out);
    case Filter::cubic:
      return picture_row<4>(instruction, u, v, n, out);
  }
}

}  // namespace mc::graph
