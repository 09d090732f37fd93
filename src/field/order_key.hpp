// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "field/visit_type.hpp"

// Unsigned integers that order as the samples do, so that ranks can be found by digits. Of floats,
// -0 comes just before 0 and NaNs lie at both ends.

namespace mc::field {

template <class T>
using OrderKey = typename Bits<sizeof(T)>::type;

template <class T>
inline constexpr OrderKey<T> kTopBit = static_cast<OrderKey<T>>(OrderKey<T>{1}
                                                                << (8 * sizeof(T) - 1));

template <class T>
OrderKey<T> order_key(T sample) {
  OrderKey<T> bits;
  std::memcpy(&bits, &sample, sizeof bits);
  if constexpr (std::is_unsigned_v<T>) {
    return bits;
  } else if constexpr (std::is_integral_v<T>) {
    return static_cast<OrderKey<T>>(bits ^ kTopBit<T>);
  } else {
    const bool negative = (bits & kTopBit<T>) != 0;
    return static_cast<OrderKey<T>>(negative ? ~bits : bits | kTopBit<T>);
  }
}

template <class T>
T sample_of_key(OrderKey<T> key) {
  OrderKey<T> bits = key;
  if constexpr (!std::is_unsigned_v<T>) {
    const bool inverted = !std::is_integral_v<T> && (key & kTopBit<T>) == 0;
    bits = static_cast<OrderKey<T>>(inverted ? ~key : key ^ kTopBit<T>);
  }
  T sample;
  std::memcpy(&sample, &bits, sizeof sample);
  return sample;
}

template <class T>
bool is_nan(T sample) {
  if constexpr (std::is_integral_v<T>) {
    return false;
  } else {
    return std::isnan(number(sample));
  }
}

template <class T>
bool is_finite(T sample) {
  if constexpr (std::is_integral_v<T>) {
    return true;
  } else {
    return std::isfinite(number(sample));
  }
}

}  // namespace mc::field
