// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "source/json/json_tree.hpp"

// A tree back to text: one line, without spaces, numbers as they were written.

namespace mc::source {

/// Appends the value.
void write_json(const JsonValue& value, std::string& out);
/// Appends a string in quotes.
void write_json_text(std::string_view text, std::string& out);

}  // namespace mc::source
