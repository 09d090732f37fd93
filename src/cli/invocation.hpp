// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "cli/messages/console.hpp"
#include "cli/messages/failure.hpp"

// What every command is handed, and the commands.

namespace mc::cli {

struct Invocation {
  Console console;
  std::stop_source stop;
};

/// Shows what went wrong; returns the exit status.
int show(Console& console, const Failure& failure);

/// Text to stdout. Errors: output, when stdout takes no more.
void print_out(std::string_view text);

/// Each runs one command from its words (those after its name) and returns the exit status.
int run_extract(Invocation& invocation, std::vector<std::string> words);
int run_edit(Invocation& invocation, std::vector<std::string> words);
int run_sample(Invocation& invocation, std::vector<std::string> words);
int run_info(Invocation& invocation, std::vector<std::string> words);
int run_check(Invocation& invocation, std::vector<std::string> words);
int run_bench(Invocation& invocation, std::vector<std::string> words);
int run_completion(Invocation& invocation, std::vector<std::string> words);
int run_help(Invocation& invocation, std::vector<std::string> words);

/// `mc --version`, with what was built in when `verbose`.
std::string version_text(bool verbose);

}  // namespace mc::cli
