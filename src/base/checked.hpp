// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <optional>

// Sizes that come from files are multiplied here, so that an overflow is an answer, not a wrap.

namespace mc::base {

template <std::unsigned_integral T>
[[nodiscard]] constexpr std::optional<T> checked_mul(T a, T b) {
  T product{};
  return __builtin_mul_overflow(a, b, &product) ? std::nullopt : std::optional<T>(product);
}

template <std::unsigned_integral T, std::same_as<T>... Rest>
[[nodiscard]] constexpr std::optional<T> checked_mul(T a, T b, T c, Rest... rest) {
  const std::optional<T> ab = checked_mul(a, b);
  return ab ? checked_mul(*ab, c, rest...) : std::nullopt;
}

template <std::unsigned_integral T>
[[nodiscard]] constexpr std::optional<T> checked_add(T a, T b) {
  T sum{};
  return __builtin_add_overflow(a, b, &sum) ? std::nullopt : std::optional<T>(sum);
}

}  // namespace mc::base
