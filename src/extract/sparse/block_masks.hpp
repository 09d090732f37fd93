// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "field/block.hpp"

// Sets of the blocks of a node, and of the blocks beside them, by word arithmetic.

namespace mc::extraction {

using field::Mask512;
using field::operator|;

inline constexpr std::uint64_t kColumn0 = 0x0101010101010101ULL;  ///< x = 0 in every row

/// Bits of the neighbours at +x, +y, +z: `next` is the node on that side.
[[nodiscard]] inline Mask512 from_x(const Mask512& m, const Mask512& next) {
  Mask512 out;
  for (std::size_t w = 0; w < 8; ++w) {
    out[w] = ((m[w] & ~kColumn0) >> 1) | ((next[w] & kColumn0) << 7);
  }
  return out;
}
[[nodiscard]] inline Mask512 from_y(const Mask512& m, const Mask512& next) {
  Mask512 out;
  for (std::size_t w = 0; w < 8; ++w) out[w] = (m[w] >> 8) | (next[w] << 56);
  return out;
}
[[nodiscard]] inline Mask512 from_z(const Mask512& m, const Mask512& next) {
  return {m[1], m[2], m[3], m[4], m[5], m[6], m[7], next[0]};
}

/// For each block: whether any of the 2x2x2 blocks from it upwards is set. m[x + 2y + 4z] are
/// nodes.
[[nodiscard]] inline Mask512 any_upwards(const std::array<Mask512, 8>& m) {
  std::array<Mask512, 4> x;
  for (std::size_t n = 0; n < 4; ++n) x[n] = m[2 * n] | from_x(m[2 * n], m[2 * n + 1]);
  const Mask512 y0 = x[0] | from_y(x[0], x[1]);
  const Mask512 y1 = x[2] | from_y(x[2], x[3]);
  return y0 | from_z(y0, y1);
}

}  // namespace mc::extraction
