// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

// The integer hashes of the noises. All arithmetic is modulo 2^32, so it is the same everywhere.

namespace mc::graph {

/// A bijection of 32 bits in which every input bit reaches every output bit.
[[nodiscard]] constexpr std::uint32_t scramble(std::uint32_t h) noexcept {
  h ^= h >> 16;
  h *= 0x7FEB352DU;
  h ^= h >> 15;
  h *= 0x846CA68BU;
  h ^= h >> 16;
  return h;
}

/// The hash of two numbers; of a document's seed and a node's, of a seed and an octave.
[[nodiscard]] constexpr std::uint32_t combine(std::uint32_t first, std::uint32_t second) noexcept {
  return scramble(scramble(first + 0x9E3779B9U) ^ (second * 0x85EBCA6BU));
}

inline constexpr std::uint32_t kPrimeX = 0x1FB2C5E5U;
inline constexpr std::uint32_t kPrimeY = 0x49A6D1B3U;
inline constexpr std::uint32_t kPrimeZ = 0x6C8E9CF5U;

/// The hash of a lattice point from its coordinates times the primes above. The best bits are the
/// highest: take those.
[[nodiscard]] constexpr std::uint32_t hash_point(std::uint32_t seed, std::uint32_t x_primed,
                                                 std::uint32_t y_primed,
                                                 std::uint32_t z_primed) noexcept {
  std::uint32_t h = seed ^ x_primed ^ y_primed ^ z_primed;
  h *= 0x2C1B3C6DU;
  h ^= h >> 15;
  h *= 0x297A2D39U;
  return h;
}

}  // namespace mc::graph
