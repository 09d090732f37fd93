// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "graph/interval_math.hpp"

// Bounds of arithmetic, for ops.def: over known values.

namespace mc::graph {

[[nodiscard]] Interval fraction(Interval a);
[[nodiscard]] Interval sine(Interval a);
[[nodiscard]] Interval power(Interval a, Interval b);
[[nodiscard]] Interval remainder(Interval a, Interval b);
[[nodiscard]] Interval smooth_step(Interval a, float edge, float width);
[[nodiscard]] Interval mixture(Interval a, Interval b, Interval c);
[[nodiscard]] Interval blended(Interval a, Interval b, Interval t);
[[nodiscard]] Interval curve_piece(Interval a, const std::array<float, 6>& p);
[[nodiscard]] Interval repetition(Interval a, const std::array<float, 6>& p);
[[nodiscard]] Interval weight(Interval amplitude, Interval noise, float gain, float weighted);
[[nodiscard]] Interval smooth_least(Interval a, Interval b, float k);

}  // namespace mc::graph
