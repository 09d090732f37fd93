// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "mc/base.hpp"

// Sets of 8x8x8 things, such as the blocks of a node, and what lies beside them, by word
// arithmetic.

namespace mc::extraction {

/// 512 bits for 8x8x8 things: word z, bit y*8 + x.
using Mask512 = std::array<std::uint64_t, 8>;

inline constexpr std::uint64_t kColumn0 = 0x0101010101010101ULL;  ///< x = 0 in every row

/// Word and bit of a block in its node, or of a sample in its block.
struct BitPlace {
  std::size_t word;
  unsigned bit;
};
[[nodiscard]] inline BitPlace bit_place(const Index3& p) {
  return {static_cast<std::size_t>(p[2] & 7), static_cast<unsigned>((p[1] & 7) * 8 + (p[0] & 7))};
}
[[nodiscard]] inline bool test(const Mask512& mask, BitPlace p) {
  return ((mask[p.word] >> p.bit) & 1U) != 0;
}
inline void set(Mask512& mask, BitPlace p) { mask[p.word] |= std::uint64_t{1} << p.bit; }

/// Ones of a mask before a place.
[[nodiscard]] inline std::uint32_t rank_in(const Mask512& mask, BitPlace p) {
  int rank = std::popcount(mask[p.word] & ((std::uint64_t{1} << p.bit) - 1));
  for (std::size_t w = 0; w < p.word; ++w) rank += std::popcount(mask[w]);
  return static_cast<std::uint32_t>(rank);
}
[[nodiscard]] inline std::uint32_t ones_in(const Mask512& mask) {
  int n = 0;
  for (const std::uint64_t word : mask) n += std::popcount(word);
  return static_cast<std::uint32_t>(n);
}

[[nodiscard]] inline Mask512 operator|(const Mask512& a, const Mask512& b) {
  Mask512 out;
  for (std::size_t w = 0; w < 8; ++w) out[w] = a[w] | b[w];
  return out;
}

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
