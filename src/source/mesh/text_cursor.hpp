// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <concepts>
#include <cstddef>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "source/mesh/mesh_input.hpp"

// Words and numbers of a text file, without copies and free of locale. "#" begins a comment that
// ends with the line.

namespace mc::source {

class TextCursor {
 public:
  /// Whether words are looked for beyond the end of the line. Within a line, a backslash before the
  /// line's end joins it to the next, as OBJ has it.
  enum class Words { across_lines, within_line };

  TextCursor(const MeshInput& input, Words words, std::size_t offset = 0)
      : input_(input),
        at_(input.text().data() + offset),
        end_(input.text().data() + input.text().size()),
        mark_(at_),
        across_lines_(words == Words::across_lines) {}

  /// The next word; empty at the end (of the line, or of the file).
  std::string_view word() {
    skip_space();
    mark_ = at_;
    while (at_ != end_ && !ends_word(*at_)) {
      ++at_;
    }
    return {mark_, static_cast<std::size_t>(at_ - mark_)};
  }

  /// The next word as a number. Errors: input ("'x1' is no number: expected `what`").
  template <class T>
  T number(std::string_view what) {
    skip_space();
    mark_ = at_;
    T value{};
    const std::errc fault = scan(value);
    if (fault != std::errc{} || (at_ != end_ && !ends_word(*at_))) {
      bad_number(fault, what);
    }
    return value;
  }

  /// A whole number at this very place, where more of the word may follow.
  template <std::integral T>
  T leading_integer(std::string_view what) {
    T value{};
    const std::errc fault = scan(value);
    if (fault != std::errc{}) {
      bad_number(fault, what);
    }
    return value;
  }

  /// Takes `c` if it comes next.
  bool take(char c) {
    const bool is_next = at_ != end_ && *at_ == c;
    at_ += is_next ? 1 : 0;
    return is_next;
  }

  /// Whether a word begins right here or the last one ended here.
  [[nodiscard]] bool word_ended() const { return at_ == end_ || ends_word(*at_); }

  /// Whether nothing is left of the line (or of the file); skips space.
  bool at_end() {
    skip_space();
    mark_ = at_;
    return at_ == end_ || (!across_lines_ && *at_ == '\n');
  }

  /// Goes behind the end of this line. False: the file ended.
  bool skip_line() {
    while (at_ != end_ && *at_ != '\n') {
      ++at_;
    }
    return take('\n');
  }

  [[nodiscard]] bool at_file_end() const { return at_ == end_; }
  [[nodiscard]] std::size_t offset() const {
    return static_cast<std::size_t>(at_ - input_.text().data());
  }
  [[nodiscard]] std::size_t bytes_left() const { return static_cast<std::size_t>(end_ - at_); }

  /// Throws at the last word: "'WORD': `fault`", or that the line or file ends there.
  [[noreturn]] void fail(std::string_view fault) const;

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  static bool ends_word(char c) { return is_space(c); }

  void skip_space() {
    for (; at_ != end_; ++at_) {
      if (*at_ == '#') {
        at_ = line_end();
      }
      if (at_ == end_ || (*at_ == '\n' && !across_lines_)) {
        return;
      }
      if (!is_space(*at_) && !skip_joint()) {
        return;
      }
    }
  }

  /// At a backslash that joins two lines: goes to the line's end, and says so.
  bool skip_joint() {
    if (across_lines_ || *at_ != '\\') {
      return false;
    }
    const char* next = at_ + 1;
    next += next != end_ && *next == '\r' ? 1 : 0;
    if (next == end_ || *next != '\n') {
      return false;
    }
    at_ = next;
    return true;
  }

  [[nodiscard]] const char* line_end() const {
    const char* at = at_;
    while (at != end_ && *at != '\n') {
      ++at;
    }
    return at;
  }

  template <class T>
  std::errc scan(T& value) {
    const char* from = at_;
    if (end_ - from >= 2 && *from == '+' && from[1] != '-') {
      ++from;
    }
    const std::from_chars_result result = std::from_chars(from, end_, value);
    if (result.ec == std::errc{}) {
      at_ = result.ptr;
    }
    return result.ec;
  }

  [[noreturn]] void bad_number(std::errc fault, std::string_view what) const;

  const MeshInput& input_;
  const char* at_;
  const char* end_;
  const char* mark_;  // where the last word began
  bool across_lines_;
};

}  // namespace mc::source
