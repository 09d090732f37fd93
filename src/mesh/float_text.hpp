// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

// Floats as text; compiled for every SIMD target.

namespace mc::mesh {

/// A float as the shortest text that reads back the same. Sixteen bytes, so that it can be copied
/// without a call.
struct FloatText {
  std::array<char, 15> text;
  std::uint8_t n;  ///< characters; 0: the float was left to the caller
};

/// Prints floats of 0 and of sizes in [10^-3, 10^5), as std::to_chars does. All others are left to
/// the caller, and on scalar and SVE targets all floats.
/// Source   R. Giulietti, "The Schubfach way to render doubles", 2020. Differs: in this range the
///          fixed notation is the shortest, and all products are exact in 64 bits, so that no table
///          of rounded powers is needed.
void print_floats(const float* x, std::size_t n, FloatText* to);

}  // namespace mc::mesh
