// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace mc::field {

/// to_float() of every number of an array, in a form that compilers turn into vectors: a half's
/// exponent and fraction are shifted into a float's place and scaled by 2^(127-15), which is exact
/// for subnormals too; infinities and NaNs get their exponent back. `halves` need not be aligned.
template <class T>
void widen_halves(const std::byte* halves, std::size_t n, T* out) noexcept {
  for (std::size_t i = 0; i < n; ++i) {
    std::uint16_t half = 0;
    std::memcpy(&half, halves + i * sizeof half, sizeof half);
    const std::uint32_t bits = half;
    const float scaled = std::bit_cast<float>((bits & 0x7FFFU) << 13U) * 0x1p112F;
    const std::uint32_t special = (bits & 0x7C00U) == 0x7C00U ? 0x7F800000U : 0U;
    const std::uint32_t sign = (bits & 0x8000U) << 16U;
    out[i] =
        static_cast<T>(std::bit_cast<float>(std::bit_cast<std::uint32_t>(scaled) | special | sign));
  }
}

}  // namespace mc::field
