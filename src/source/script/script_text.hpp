// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

// The text of a script, piece by piece: the header or the whole document first, then lines. A file
// or a text in memory lies there whole; a stream gives what has come.

namespace mc::source {

/// Part of the text, valid until the next is taken.
struct TextPiece {
  std::string_view text;
  std::size_t line = 1;     ///< where it starts
  bool is_complete = true;  ///< a line that was ended, or at least a whole JSON value
};

class ScriptText {
 public:
  virtual ~ScriptText() = default;
  /// Lines up to and with the one on which the first JSON value ends; all there is where none does.
  /// Errors   input: cannot be read; limit: longer than Script::kMostLineBytes.
  [[nodiscard]] virtual TextPiece head() = 0;
  /// The next line, without its end; none at the end.
  [[nodiscard]] virtual std::optional<TextPiece> line() = 0;
  /// Everything from the start on.
  [[nodiscard]] virtual std::string_view whole() = 0;
  /// Starts anew after the head. Precondition: not a stream's.
  virtual void rewind() = 0;
  [[nodiscard]] virtual bool is_stream() const = 0;
};

/// Over memory that outlives it.
[[nodiscard]] std::unique_ptr<ScriptText> text_in_memory(std::string_view text);
/// Over a descriptor, which stays open; `place` is how messages name it.
[[nodiscard]] std::unique_ptr<ScriptText> text_of_stream(int descriptor, std::string place);

}  // namespace mc::source
