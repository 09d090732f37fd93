// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

// Small treatments of text from files, free of locale.

namespace mc::source {

/// Without blanks, tabs and carriage returns at either end.
[[nodiscard]] std::string_view trimmed(std::string_view text);
/// In quotes, for messages: at most 60 bytes, nothing that a terminal would obey.
[[nodiscard]] std::string quoted_text(std::string_view text);

}  // namespace mc::source
