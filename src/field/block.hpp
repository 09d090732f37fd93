// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "mc/field.hpp"

// Blocks of 8x8x8 samples, which sparse volumes, edits and the sparse engine share: which block an
// index lies in, the order of blocks, and sets of a block's samples. Blocks of blocks (nodes) use
// the same words, with a block in place of a sample.

namespace mc::field {

inline constexpr std::int32_t kBlockSize = 8;  ///< samples along each axis
inline constexpr std::size_t kBlockSamples = 512;
static_assert(kBlockSamples == LeafReader::kLeafSamples);

/// The block that holds a sample: division by 8, rounding down.
[[nodiscard]] constexpr std::int32_t block_of(std::int32_t index) { return index >> 3; }
[[nodiscard]] inline Index3 block_of(const Index3& p) {
  return {block_of(p[0]), block_of(p[1]), block_of(p[2])};
}
[[nodiscard]] inline IndexBox blocks_of(const IndexBox& box) {
  return {block_of(box.lo), block_of(box.hi)};
}
/// Index of a block's first sample.
[[nodiscard]] inline Index3 origin_of(const Index3& block) {
  return {block[0] * kBlockSize, block[1] * kBlockSize, block[2] * kBlockSize};
}
[[nodiscard]] inline IndexBox samples_of(const Index3& block) {
  const Index3 lo = origin_of(block);
  return {lo, {lo[0] + (kBlockSize - 1), lo[1] + (kBlockSize - 1), lo[2] + (kBlockSize - 1)}};
}

/// Ordered by (z, y, x).
[[nodiscard]] inline bool comes_before(const Index3& a, const Index3& b) {
  if (a[2] != b[2]) return a[2] < b[2];
  if (a[1] != b[1]) return a[1] < b[1];
  return a[0] < b[0];
}
/// Whether two indices are equal. Faster than ==, which compiles to a call of memcmp.
[[nodiscard]] inline bool same(const Index3& a, const Index3& b) {
  return ((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2])) == 0;
}

/// For hash tables of indices, of which also the low bits are well mixed.
struct IndexHash {
  std::size_t operator()(const Index3& p) const noexcept {
    const auto part = [](std::int32_t v) { return std::uint64_t{static_cast<std::uint32_t>(v)}; };
    std::uint64_t h = part(p[0]) * 0x9E3779B97F4A7C15U;
    h = (std::rotl(h, 21) ^ part(p[1])) * 0xC2B2AE3D27D4EB4FU;
    h = (std::rotl(h, 21) ^ part(p[2])) * 0x165667B19E3779F9U;
    return h ^ h >> 29U;
  }
};

/// One bit for each sample of a block: word z, bit 8 y + x.
using Mask512 = std::array<std::uint64_t, kBlockSize>;

/// Word and bit of a sample in its block.
struct BitIndex {
  std::size_t word;
  unsigned bit;
};
[[nodiscard]] inline BitIndex bit_index(const Index3& p) {
  return {static_cast<std::size_t>(p[2] & 7), static_cast<unsigned>((p[1] & 7) * 8 + (p[0] & 7))};
}
[[nodiscard]] inline bool test(const Mask512& mask, BitIndex at) {
  return ((mask[at.word] >> at.bit) & 1U) != 0;
}
inline void set(Mask512& mask, BitIndex at) { mask[at.word] |= std::uint64_t{1} << at.bit; }

[[nodiscard]] inline std::uint32_t n_ones(const Mask512& mask) {
  int n = 0;
  for (const std::uint64_t word : mask) n += std::popcount(word);
  return static_cast<std::uint32_t>(n);
}
/// Ones of a mask before a bit.
[[nodiscard]] inline std::uint32_t rank_in(const Mask512& mask, BitIndex at) {
  int rank = std::popcount(mask[at.word] & ((std::uint64_t{1} << at.bit) - 1));
  for (std::size_t w = 0; w < at.word; ++w) rank += std::popcount(mask[w]);
  return static_cast<std::uint32_t>(rank);
}
[[nodiscard]] inline Mask512 operator|(const Mask512& a, const Mask512& b) {
  Mask512 out;
  for (std::size_t w = 0; w < a.size(); ++w) out[w] = a[w] | b[w];
  return out;
}

/// Index of sample (x, y, z) of a block, each from 0 to 7, among the values of a leaf.
[[nodiscard]] constexpr std::size_t leaf_index(std::int32_t x, std::int32_t y, std::int32_t z) {
  const std::int32_t n = x * 64 + y * 8 + z;
  return static_cast<std::size_t>(n);
}

}  // namespace mc::field
