// SPDX-License-Identifier: MIT
#pragma once

#include "graph/program.hpp"
#include "mc/graph.hpp"

// What values a noise can take, for whoever wants bounds of a field.

namespace mc::graph {

/// The lowest and highest value.
struct NoiseRange {
  float lo;
  float hi;
};

/// The farthest that the nearest point, or the second nearest, of cellular noise can be: that of
/// the sample's own cell, or of its nearest neighbour, in the far corner.
[[nodiscard]] inline float farthest_point(bool flat, CellMetric metric) noexcept {
  switch (metric) {
    case CellMetric::euclidean:
      return flat ? 1.5811388F : 1.7320508F;
    case CellMetric::manhattan:
      return flat ? 2.0F : 3.0F;
    default:
      return 1.5F;
  }
}

/// Bounds of a noise over all coordinates that are numbers; a coordinate that is NaN gives NaN.
/// They hold for the rounded values: formulas whose exact range is [-1, 1] to 1e-5 may pass it.
[[nodiscard]] inline NoiseRange noise_range(const Instruction& instruction) noexcept {
  constexpr float kOne = 1.0F + 0x1p-16F;
  switch (instruction.op) {
    case Op::unity2:  // gradients of the z = 0 slice: |n| <= 1
      return {(-kOne + 0.69F) / 1.483F, (kOne + 0.69F) / 1.483F};
    case Op::cellular2:
    case Op::cellular3: {
      if (static_cast<CellReturn>(instruction.p[2]) == CellReturn::value) return {-kOne, kOne};
      const auto metric = static_cast<CellMetric>(instruction.p[3]);
      return {0, kOne * farthest_point(instruction.op == Op::cellular2, metric)};
    }
    default:
      return {-kOne, kOne};
  }
}

}  // namespace mc::graph
