// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments/args.hpp"

// Words to option targets, by CLI11, which is used nowhere else. Its errors leave as ours.

namespace mc::cli {

/// Fills the targets of `options` and `inputs` from a command's words.
/// `command` names it in messages ("extract"); `inputs` may be null where there are none.
/// Errors   usage: an unknown option (with the nearest known one), a missing value, a repeated
///          option, an unexpected word.
void parse_words(std::string_view command, std::span<const Option> options,
                 std::vector<std::string>* inputs, std::vector<std::string> words);

/// The names of one option: "-o,--output" to "-o" and "--output".
std::vector<std::string_view> option_names(const Option& option);

/// The words as a shell would take them again.
std::string shell_text(std::span<const std::string> words);

}  // namespace mc::cli
