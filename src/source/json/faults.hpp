// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "mc/base.hpp"

// The faults of one JSON text, collected so that all are reported at once.

namespace mc::source {

/// One-based, as editors count: the column is in characters, not bytes.
struct TextPosition {
  std::size_t line = 1;
  std::size_t column = 1;
};
[[nodiscard]] TextPosition position_in(std::string_view text, std::size_t offset);

class Faults {
 public:
  static constexpr std::size_t kMost = 20;       ///< reported
  static constexpr std::size_t kMostKept = 100;  ///< so that a hostile text costs no more

  /// `text` is borrowed. `place` is how messages name the file.
  Faults(std::string place, std::string_view text) : place_(std::move(place)), text_(text) {}
  /// Of a text that is part of the file: it starts at line `first_line`, and is called `label`.
  Faults(std::string place, std::string_view text, std::size_t first_line, std::string label)
      : place_(std::move(place)), text_(text), first_line_(first_line), label_(std::move(label)) {}

  /// `pointer` is the JSON Pointer of what is at fault, empty for the document.
  void add(std::size_t offset, const std::string& pointer, const std::string& message,
           ErrorKind kind = ErrorKind::usage);

  /// Past kMostKept faults the rest is only counted: then call skip() and spare the message.
  [[nodiscard]] bool full() const { return faults_.size() >= kMostKept; }
  void skip() { ++n_skipped_; }

  [[nodiscard]] bool empty() const { return faults_.empty(); }
  [[nodiscard]] const std::string& place() const { return place_; }
  [[nodiscard]] std::string_view text() const { return text_; }
  /// "line L, column C", to refer to another place from a message.
  [[nodiscard]] std::string where(std::size_t offset) const;

  /// Throws an Error with a line a fault, by place in the text; at most kMost, the last of which
  /// counts the rest. It is of kind limit if all faults are, else usage.
  void throw_if_any() const;

 private:
  struct Fault {
    std::size_t offset;
    std::string line;
    ErrorKind kind;
  };
  [[nodiscard]] TextPosition position(std::size_t offset) const;

  std::string place_;
  std::string_view text_;
  std::size_t first_line_ = 1;
  std::string label_;  // "record 3"; or ""
  std::vector<Fault> faults_;
  std::size_t n_skipped_ = 0;
};

/// The candidate that `name` is most likely a slip of; empty where none is near.
/// Cost     O(candidates * length^2).
/// Source   Damerau 1964 (optimal string alignment); near is at most a third of the letters, and
///          one at least.
[[nodiscard]] std::string nearest_name(std::string_view name,
                                       const std::vector<std::string>& candidates);

/// `did you mean "octaves"?`, or `expected one of "a", "b"` where nothing is near.
[[nodiscard]] std::string suggestion(std::string_view name,
                                     const std::vector<std::string>& candidates);

/// In double quotes, control characters and what is too long left out.
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace mc::source
