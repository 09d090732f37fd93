// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <charconv>
#include <string>
#include <string_view>

// Numbers and lines of text formats. std::to_chars knows no locale and prints the shortest text
// that reads back as the same number.

namespace mc::sink {

template <class Number>
void append_number(std::string& to, Number value) {
  std::array<char, 32> digits;  // the longest: "-1.2345678901234567e-308", 20 digits of 64 bits
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  to.append(digits.data(), end);
}

/// Appends `separator` and a number, three times.
template <class Number>
void append_triple(std::string& to, const Number* xyz, char separator = ' ') {
  for (int a = 0; a < 3; ++a) {
    to += separator;
    append_number(to, xyz[a]);
  }
}

/// `text` with every control character made a space, so that it stays on its line.
inline std::string on_one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    c = static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? ' ' : c;
  }
  return line;
}

}  // namespace mc::sink
