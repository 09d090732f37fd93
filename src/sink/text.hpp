// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "mesh/float_text.hpp"
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
/// Triples of floats as text, made block by block.
class TripleTexts {
 public:
  /// Borrows the floats.
  explicit TripleTexts(std::span<const float> xyz) : xyz_(xyz) {}

  /// Prints triple n like print_triple(); to be asked for in order, from 0 on.
  char* print(char* at, std::size_t n) {
    if (n % kBlock == 0) start_block(n);
    at = print_one(at, n, 0);
    *at++ = ' ';
    at = print_one(at, n, 1);
    *at++ = ' ';
    return print_one(at, n, 2);
  }

 private:
  static constexpr std::size_t kBlock = 64;

  void start_block(std::size_t n) {
    const std::size_t n_floats = std::min(3 * kBlock, xyz_.size() - 3 * n);
    mesh::print_floats(&xyz_[3 * n], n_floats, texts_.data());
  }
  char* print_one(char* at, std::size_t n, std::size_t axis) const {
    const mesh::FloatText& made = texts_[3 * (n % kBlock) + axis];
    if (made.n == 0) return print_number(at, xyz_[3 * n + axis]);
    std::memcpy(at, &made, sizeof made);
    return at + made.n;
  }

  std::span<const float> xyz_;
  std::array<mesh::FloatText, 3 * kBlock> texts_;
};

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
