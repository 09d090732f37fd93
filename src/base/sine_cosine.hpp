// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

// Sine and cosine that are the same bits everywhere: the C library's are not.

namespace mc::base {

struct SineCosine {
  double sine;
  double cosine;
};

/// Of so many quarter turns and `rest` radians, within +-pi/4: Taylor's series, whose error there
/// is below 1e-16. Whole quarters are exact.
inline SineCosine sine_cosine(std::uint64_t quarters, double rest) {
  const auto series = [q = -(rest * rest)](int first) {
    double sum = 1;
    for (int n = first + 14; n >= first; n -= 2) sum = 1 + q / (n * (n + 1.0)) * sum;
    return sum;
  };
  const double sine = rest * series(2);
  const double cosine = series(1);
  switch (quarters % 4) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

}  // namespace mc::base
