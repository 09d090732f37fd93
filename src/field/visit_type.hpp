// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include "mc/field.hpp"

// From a SampleType at run time to a C++ type at compile time, and loads of single samples.

namespace mc::field {

template <class T>
struct TypeTag {
  using type = T;
};

/// Calls `f(TypeTag<T>{})` for the C++ type of `type` (Half for f16).
template <class F>
decltype(auto) visit_type(SampleType type, F&& f) {
  switch (type) {
    case SampleType::u8:
      return f(TypeTag<std::uint8_t>{});
    case SampleType::i8:
      return f(TypeTag<std::int8_t>{});
    case SampleType::u16:
      return f(TypeTag<std::uint16_t>{});
    case SampleType::i16:
      return f(TypeTag<std::int16_t>{});
    case SampleType::u32:
      return f(TypeTag<std::uint32_t>{});
    case SampleType::i32:
      return f(TypeTag<std::int32_t>{});
    case SampleType::i64:
      return f(TypeTag<std::int64_t>{});
    case SampleType::f16:
      return f(TypeTag<Half>{});
    case SampleType::f32:
      return f(TypeTag<float>{});
    case SampleType::f64:
      return f(TypeTag<double>{});
  }
  __builtin_unreachable();
}

template <class T>
constexpr SampleType type_of() {
  if constexpr (std::is_same_v<T, std::uint8_t>) return SampleType::u8;
  if constexpr (std::is_same_v<T, std::int8_t>) return SampleType::i8;
  if constexpr (std::is_same_v<T, std::uint16_t>) return SampleType::u16;
  if constexpr (std::is_same_v<T, std::int16_t>) return SampleType::i16;
  if constexpr (std::is_same_v<T, std::uint32_t>) return SampleType::u32;
  if constexpr (std::is_same_v<T, std::int32_t>) return SampleType::i32;
  if constexpr (std::is_same_v<T, std::int64_t>) return SampleType::i64;
  if constexpr (std::is_same_v<T, Half>) return SampleType::f16;
  if constexpr (std::is_same_v<T, float>) return SampleType::f32;
  if constexpr (std::is_same_v<T, double>) return SampleType::f64;
}

/// The sample as a number to calculate with: Half becomes float, all else stays what it is.
template <class T>
auto number(T sample) {
  if constexpr (std::is_same_v<T, Half>) {
    return to_float(sample);
  } else {
    return sample;
  }
}

template <std::size_t N>
struct Bits;
template <>
struct Bits<1> {
  using type = std::uint8_t;
};
template <>
struct Bits<2> {
  using type = std::uint16_t;
};
template <>
struct Bits<4> {
  using type = std::uint32_t;
};
template <>
struct Bits<8> {
  using type = std::uint64_t;
};

template <std::size_t N>
constexpr typename Bits<N>::type byte_swapped(typename Bits<N>::type v) {
  if constexpr (N == 2) return __builtin_bswap16(v);
  if constexpr (N == 4) return __builtin_bswap32(v);
  if constexpr (N == 8) return __builtin_bswap64(v);
  return v;
}

/// The sample at a byte address of any alignment, in the file's byte order (`Swap`: not ours).
template <class T, bool Swap>
T load_sample(const std::byte* at) {
  typename Bits<sizeof(T)>::type bits;
  std::memcpy(&bits, at, sizeof bits);
  if constexpr (Swap) {
    bits = byte_swapped<sizeof(T)>(bits);
  }
  T value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace mc::field
