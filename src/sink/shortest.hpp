// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

// Numbers as the shortest text that reads back the same, without a branch that depends on the
// digits: the same bytes as std::to_chars, several times faster. Floats after R. Giulietti, "The
// Schubfach way to render doubles", 2020. Differs: only floats in [10^-3, 10^5), where no notation
// is shorter than the fixed one and all products are exact in 64 bits, so that no table of rounded
// powers is needed.

namespace mc::sink {

/// Integers below this are printed fast.
constexpr std::uint64_t kFastIntegers = 100000000;

/// Eight digits of n < 10^8, zeros in front; the first is the lowest byte.
inline std::uint64_t eight_digits(std::uint32_t n) {
  // Two lanes of four digits become four of two, and those eight of one.
  std::uint64_t lanes = n / 10000 | (std::uint64_t{n % 10000} << 32);
  const std::uint64_t hundreds = ((lanes * 10486) >> 20) & 0x7F0000007F;
  lanes = hundreds | ((lanes - 100 * hundreds) << 16);
  const std::uint64_t tens = ((lanes * 103) >> 10) & 0x000F000F000F000F;
  return tens | ((lanes - 10 * tens) << 8) | 0x3030303030303030;
}

/// Of eight digits, the zeros in front of the last.
inline int leading_zeros(std::uint64_t digits) {
  constexpr std::uint64_t kLastCounts = std::uint64_t{1} << 56;
  return std::countr_zero((digits ^ 0x3030303030303030) | kLastCounts) / 8;
}

/// The text of an integer: the first character is the lowest byte.
struct ShortText {
  std::uint64_t characters;
  std::size_t n;
};

/// The text of n < 10^8.
inline ShortText small_text(std::uint32_t n) {
  const std::uint64_t digits = eight_digits(n);
  const int zeros = leading_zeros(digits);
  return {digits >> (8 * zeros), static_cast<std::size_t>(8 - zeros)};
}

/// Writes `text` at `at`, where there is room for 8 bytes, and returns its end.
inline char* print_short(char* at, const ShortText& text) {
  std::memcpy(at, &text.characters, sizeof text.characters);
  return at + text.n;
}

/// Writes n < 10^8 at `at`, where there is room for 8 bytes, and returns its end.
inline char* print_small(char* at, std::uint32_t n) { return print_short(at, small_text(n)); }

/// digits * 10^exponent
struct Decimal {
  std::uint32_t digits;
  int exponent;
};

/// Whether shortest_decimal() takes x.
inline bool is_in_fast_range(float x) {
  const float size = std::fabs(x);
  return size >= 1e-3F && size < 1e5F;
}

/// The decimal with the fewest digits, zeros at its end aside, that reads back as |x|, and of those
/// the nearest. Less than 10^9 digits; the exponent is negative.
/// Precondition: is_in_fast_range(x).
inline Decimal shortest_decimal(float x) {
  constexpr std::uint64_t kPowersOf10[] = {1,         10,         100,         1000,
                                           10000,     100000,     1000000,     10000000,
                                           100000000, 1000000000, 10000000000, 100000000000};
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t fraction = bits & 0x7FFFFF;
  const std::uint64_t c = fraction | 0x800000;  // |x| = c 2^q, q in [-33, -7]
  const int q = static_cast<int>((bits >> 23) & 0xFF) - 150;
  // 10^k is the largest power not above the interval that rounds to x, which is narrower below a
  // power of two: k = floor(q log10(2)), or that of 3/4 2^q.
  const bool is_power = fraction == 0;
  const int k = (q * 1262611 - (is_power ? 524031 : 0)) >> 22;
  // |x| = value / unit in 10^k, and how far from it what rounds to x may lie. Ties go to even: an
  // odd float does not own its ends.
  const std::uint64_t power = kPowersOf10[-k];
  const std::uint64_t value = c * power;
  const std::uint64_t unit = std::uint64_t{1} << -q;
  const std::uint64_t open = c & 1;
  const std::uint64_t most_down = (is_power ? power / 4 : power / 2) - open;
  const std::uint64_t most_up = power / 2 - open;
  const std::uint64_t s = value >> -q;
  const std::uint64_t down = value & (unit - 1);
  const std::uint64_t last_digit = s % 10;
  const std::uint64_t down_to_tens = (last_digit << -q) + down;
  const bool tens_in = down_to_tens <= most_down;
  const bool next_tens_in = 10 * unit - down_to_tens <= most_up;
  const bool s_in = down <= most_down;
  const bool next_s_in = unit - down <= most_up;
  const bool nearer_next = 2 * down + (s & 1) > unit;
  const std::uint64_t one = s + ((s_in != next_s_in ? !s_in : nearer_next) ? 1 : 0);
  const std::uint64_t ten = s - last_digit + (tens_in ? 0 : 10);
  return {static_cast<std::uint32_t>(tens_in != next_tens_in ? ten : one), k};
}

/// A byte each, the first the lowest.
using NineDigits = unsigned __int128;

/// Writes x at `at`, where there is room for 24 bytes, and returns its end.
/// Precondition: is_in_fast_range(x).
inline char* print_shortest(char* at, float x) {
  const Decimal d = shortest_decimal(x);
  *at = '-';
  at += std::signbit(x) ? 1 : 0;
  const std::uint32_t first = d.digits / 100000000;
  const std::uint64_t others = eight_digits(d.digits % 100000000);
  const int cut = std::countl_zero(others ^ 0x3030303030303030) / 8;  // zeros at the end
  if (std::fabs(x) < 1) {
    // 8 to 10 digits behind the point: the nine need no zeros taken away. Of 8 the first is 0, and
    // the point takes its place.
    constexpr std::array<char, 4> kZeros{'0', '.', '0', '0'};
    std::memcpy(at, kZeros.data(), kZeros.size());
    char* const nine = at - 7 - d.exponent;
    *nine = static_cast<char>('0' + first);
    std::memcpy(nine + 1, &others, sizeof others);
    at[1] = '.';
    return nine + 9 - cut;
  }
  const int zeros = first != 0 ? 0 : 1 + leading_zeros(others);
  const NineDigits digits = (NineDigits{others} << 8 | ('0' + first)) >> (8 * zeros);
  const int n = 9 - zeros;
  const int n_whole = n + d.exponent;  // digits before the point
  const NineDigits behind = digits >> (8 * n_whole);
  std::memcpy(at, &digits, 8);
  at[n_whole] = '.';
  std::memcpy(at + n_whole + 1, &behind, sizeof behind);
  return n - cut > n_whole ? at + n - cut + 1 : at + n_whole;
}

}  // namespace mc::sink
