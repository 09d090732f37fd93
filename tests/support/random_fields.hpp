// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

#include "field/block.hpp"
#include "field/visit_type.hpp"
#include "mc/field.hpp"

// Seeded random fields for properties and differential tests.

namespace mc::test {

enum class Noise : std::uint8_t {
  white,     ///< every sample on its own
  plateaus,  ///< few values, many of them exactly iso
  with_nan,  ///< white, with NaN and infinities (integers: extremes) strewn in
  smooth,    ///< a wave: few crossings
};

/// Samples around an iso of 3 (integers) or 0.25 (others).
template <class T>
constexpr double test_iso() {
  return std::is_integral_v<T> ? 3 : 0.25;
}

template <class T>
std::vector<T> random_field(Index3 dims, Noise noise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto n = static_cast<std::size_t>(dims[0]) * static_cast<std::size_t>(dims[1]) *
                 static_cast<std::size_t>(dims[2]);
  std::vector<T> out(n);
  const auto convert = [](double v) {
    if constexpr (std::is_same_v<T, Half>) {
      return to_half(static_cast<float>(v));
    } else if constexpr (std::is_integral_v<T>) {
      return static_cast<T>(std::lround(3 + 4 * (v - 0.25)) & 0x7F);
    } else {
      return static_cast<T>(v);
    }
  };
  std::uniform_real_distribution<double> uniform(-0.5, 1.0);
  for (std::size_t at = 0; at < n; ++at) {
    const auto i = static_cast<double>(at % static_cast<std::size_t>(dims[0]));
    const auto jk = static_cast<double>(at / static_cast<std::size_t>(dims[0]));
    double v = uniform(random);
    if (noise == Noise::plateaus) v = 0.25 * static_cast<double>(random() % 3);
    if (noise == Noise::smooth)
      v = std::sin(0.31 * i + 0.013 * static_cast<double>(seed % 97)) * std::cos(0.11 * jk);
    out[at] = convert(v);
    if constexpr (std::is_floating_point_v<T>) {
      if (noise == Noise::with_nan && random() % 8 == 0) {
        constexpr T kInfinity = std::numeric_limits<T>::infinity();
        const T odd[] = {std::numeric_limits<T>::quiet_NaN(), kInfinity, -kInfinity,
                         std::numeric_limits<T>::max(), std::numeric_limits<T>::lowest()};
        out[at] = odd[random() % 5];
      }
    }
    if constexpr (std::is_integral_v<T>) {
      if (noise == Noise::with_nan && random() % 8 == 0) {
        out[at] = random() % 2 == 0 ? std::numeric_limits<T>::max() : std::numeric_limits<T>::min();
      }
    }
  }
  return out;
}

/// A field whose blocks of 8x8x8 are noise or, three of five, one of the uniform values.
template <class T>
std::vector<T> blocky_field(Index3 dims, Noise noise, const std::array<T, 3>& uniform,
                            std::uint64_t seed) {
  std::vector<T> field = random_field<T>(dims, noise, seed);
  std::size_t at = 0;
  for (std::int32_t k = 0; k < dims[2]; ++k) {
    for (std::int32_t j = 0; j < dims[1]; ++j) {
      for (std::int32_t i = 0; i < dims[0]; ++i, ++at) {
        const std::uint64_t kind =
            (field::IndexHash{}({i / 8, j / 8, k / 8}) ^ seed * 0x9E3779B97F4A7C15U) % 5;
        if (kind < 3) field[at] = uniform[kind];
      }
    }
  }
  return field;
}

}  // namespace mc::test
