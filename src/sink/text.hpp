// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "sink/shortest.hpp"

// Numbers and lines of text formats. std::to_chars knows no locale and prints the shortest text
// that reads back as the same number.

namespace mc::sink {

/// The longest number: "-1.2345678901234567e-308"; 64 bits have 20 digits.
constexpr std::size_t kMostDigits = 24;

/// These write at `at`, where there is room for so many, and return the end of what they wrote.
inline char* print_number(char* at, double value) {
  return std::to_chars(at, at + kMostDigits, value).ptr;
}
inline char* print_number(char* at, float value) {
  return is_in_fast_range(value) ? print_shortest(at, value)
                                 : std::to_chars(at, at + kMostDigits, value).ptr;
}
inline char* print_number(char* at, std::uint64_t value) {
  return value < kFastIntegers ? print_small(at, static_cast<std::uint32_t>(value))
                               : std::to_chars(at, at + kMostDigits, value).ptr;
}
inline char* print_number(char* at, std::int64_t value) {
  return std::to_chars(at, at + kMostDigits, value).ptr;
}

inline char* print_text(char* at, std::string_view text) {
  std::memcpy(at, text.data(), text.size());
  return at + text.size();
}

/// Three numbers with a space between them.
template <class Number>
char* print_triple(char* at, const Number* xyz) {
  at = print_number(at, xyz[0]);
  *at++ = ' ';
  at = print_number(at, xyz[1]);
  *at++ = ' ';
  return print_number(at, xyz[2]);
}
constexpr std::size_t kMostTriple = 3 * kMostDigits + 2;
/// Of floats: "-1.2345678e-38" thrice; of ids that fit 32 bits, and of those a little larger.
constexpr std::size_t kFloatTriple = 3 * 15 + 2;
constexpr std::size_t kIdTriple = 3 * 10 + 2;
constexpr std::size_t kLargeIdDigits = 11;

/// `text` with every control character made a space, so that it stays on its line.
inline std::string on_one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    c = static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? ' ' : c;
  }
  return line;
}

}  // namespace mc::sink
