// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>

// Names and lists of names, free of locale.

namespace mc::base {

/// ASCII letters in lower case.
[[nodiscard]] std::string lower_case(std::string_view text);
/// The extension of a path in lower case without its dot; empty if it has none.
[[nodiscard]] std::string extension_of(std::string_view path);
/// Whether `word` is one of `words`, which have blanks between them. No word: false.
[[nodiscard]] bool has_word(std::string_view words, std::string_view word);
/// "a, b or c"; `last` stands before the last.
[[nodiscard]] std::string enumerate(std::span<const std::string_view> names,
                                    std::string_view last = "or");

}  // namespace mc::base
