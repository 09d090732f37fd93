// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

// Help on stdout: short by default, everything with -v.

namespace mc::cli {

/// Help for a command, or for the program where `command` is empty.
/// Errors   usage: no such command.
std::string help_text(std::string_view command, bool verbose);

/// The commands, in the order help shows them.
std::vector<std::string_view> command_names();

}  // namespace mc::cli
