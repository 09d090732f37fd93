// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

// To tell states of data apart: not against forgers.

namespace mc::base {

/// The hash of what `h` is the hash of, and one word more.
constexpr std::uint64_t hash_on(std::uint64_t h, std::uint64_t word) {
  h = (std::rotl(h, 23) ^ word) * 0x9E3779B97F4A7C15U;
  return h ^ h >> 32U;
}

/// The same for bytes, the last word filled up with zeros: their number is not part of it.
inline std::uint64_t hash_on(std::uint64_t h, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const std::size_t n = bytes.size() < sizeof word ? bytes.size() : sizeof word;
    std::memcpy(&word, bytes.data(), n);
    h = hash_on(h, word);
    bytes = bytes.subspan(n);
  }
  return h;
}

}  // namespace mc::base
