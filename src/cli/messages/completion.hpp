// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

// What shells complete: commands, options and their values, from the option tables.

namespace mc::cli {

/// A script for "bash", "zsh" or "fish", for a program of this name.
/// Errors   usage: another shell, a name that would need quotes.
std::string completion_script(std::string_view shell, std::string_view program);

}  // namespace mc::cli
