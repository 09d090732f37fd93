// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/arguments/args.hpp"

// Help on stdout: short by default, everything with -v.

namespace mc::cli {

/// Help for a command, or for the program where `command` is empty.
/// Errors   usage: no such command.
std::string help_text(std::string_view command, bool verbose);

/// What `mc help TOPIC` says of a topic that is no command; empty: it is none.
std::string_view topic_text(std::string_view topic);

/// The commands, in the order help shows them.
std::vector<std::string_view> command_names();
/// What a command does, in a few words.
std::string_view command_summary(std::string_view command);
/// Calls f with the options of a command; without a name, of the program itself.
void with_options(std::string_view command,
                  const std::function<void(const std::vector<Option>&)>& f);

}  // namespace mc::cli
