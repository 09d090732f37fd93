// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mc::sink {

/// Linear red, green, blue and alpha of a material in viewers that know nothing of indices: 0 is
/// the grey of meshes without materials, from 1 on seven colours that every eye can tell apart,
/// again and again. Source   Okabe and Ito, "Color universal design", 2002.
[[nodiscard]] inline std::array<std::uint8_t, 4> colour_of(std::uint16_t material) {
  constexpr std::array<std::uint8_t, 4> kGrey{153, 153, 153, 255};
  constexpr std::array<std::array<std::uint8_t, 4>, 7> kColours{{
      {202, 88, 0, 255},    // orange
      {24, 116, 208, 255},  // sky blue
      {0, 87, 44, 255},     // bluish green
      {222, 198, 14, 255},  // yellow
      {0, 43, 114, 255},    // blue
      {170, 29, 0, 255},    // vermillion
      {154, 49, 99, 255},   // reddish purple
  }};
  return material == 0 ? kGrey : kColours[(material - std::size_t{1}) % kColours.size()];
}

}  // namespace mc::sink
