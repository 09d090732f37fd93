// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>

#include "graph/program.hpp"

// What values a noise can take, for whoever wants bounds of a field.

namespace mc::graph {

/// The lowest and highest value.
struct NoiseRange {
  float lo;
  float hi;
};

/// Bounds of a noise over all coordinates that are numbers; a coordinate that is NaN gives NaN.
/// They hold for the rounded values: formulas whose exact range is [-1, 1] to 1e-5 may pass it.
[[nodiscard]] inline NoiseRange noise_range(const Instruction& instruction) noexcept {
  constexpr float kOne = 1.0F + 0x1p-10F;
  switch (instruction.op) {
    case Op::perlin2:
    case Op::perlin3:
    case Op::simplex2:
    case Op::simplex3:
      return {-kOne, kOne};
    case Op::unity2:  // gradients of the z = 0 slice: |n| <= 1
      return {(-kOne + 0.69F) / 1.483F, (kOne + 0.69F) / 1.483F};
    default:
      assert(false && "not a noise");
      return {};
  }
}

}  // namespace mc::graph
