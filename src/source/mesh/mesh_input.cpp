// SPDX-License-Identifier: MIT
#include "source/mesh/mesh_input.hpp"

#include <algorithm>

#include "source/mesh/text_cursor.hpp"

// Faults and where they are. Lines are counted only when there is one to report.

namespace mc::source {

namespace {

/// A word of the file, fit for one line of a terminal.
std::string quoted(std::string_view word) {
  constexpr std::size_t kLongest = 24;
  std::string text(word.substr(0, kLongest));
  std::ranges::replace_if(
      text, [](char c) { return c < ' ' || c > '~'; }, '?');
  return "'" + text + (word.size() > kLongest ? "...'" : "'");
}

}  // namespace

void fault_at_byte(const MeshInput& input, std::size_t offset, std::string_view fault,
                   std::string_view remedy) {
  throw Error(ErrorKind::input, input.place + " @ byte " + std::to_string(offset), fault, remedy);
}

void fault_at_line(const MeshInput& input, std::size_t offset, std::string_view fault,
                   std::string_view remedy) {
  const std::string_view before = input.text().substr(0, offset);
  const auto line = 1 + std::ranges::count(before, '\n');
  throw Error(ErrorKind::input, input.place + ":" + std::to_string(line), fault, remedy);
}

void TextCursor::fail(std::string_view fault) const {
  const char* last = mark_;
  while (last != end_ && !ends_word(*last)) {
    ++last;
  }
  const std::string_view word{mark_, static_cast<std::size_t>(last - mark_)};
  const auto offset = static_cast<std::size_t>(mark_ - input_.text().data());
  const bool ended = word.empty() || word.front() == '#';
  const std::string what = !ended          ? quoted(word)
                           : mark_ == end_ ? std::string("the file ends early")
                                           : std::string("the line ends early");
  fault_at_line(input_, offset, what + ": " + std::string(fault));
}

void TextCursor::bad_number(std::errc fault, std::string_view what) const {
  const char* const reason = fault == std::errc::result_out_of_range ? "out of range: " : "";
  fail(reason + ("expected " + std::string(what)));
}

}  // namespace mc::source
