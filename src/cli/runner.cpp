// SPDX-License-Identifier: MIT
#include "cli/runner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <utility>

#include "base/simd_target.hpp"
#include "base/text.hpp"
#include "cli/arguments/args.hpp"
#include "cli/arguments/command_line.hpp"
#include "cli/arguments/values.hpp"
#include "cli/invocation.hpp"
#include "cli/messages/help.hpp"
#include "cli/signals.hpp"
#include "mc/base.hpp"

// Finds the command and runs it; what it throws ends here.

namespace mc::cli {

namespace {

using Command = int (*)(Invocation&, std::vector<std::string>);

constexpr std::array<std::pair<std::string_view, Command>, 8> kCommands{
    {{"extract", run_extract},
     {"edit", run_edit},
     {"sample", run_sample},
     {"info", run_info},
     {"check", run_check},
     {"bench", run_bench},
     {"completion", run_completion},
     {"help", run_help}}};

void obey_simd_environment() {
  const char* name = std::getenv("MC_SIMD");
  if (name == nullptr || *name == '\0') return;
  if (!base::set_simd_target(name)) {
    throw Error(ErrorKind::usage, "MC_SIMD",
                fmt::format("this machine or build has no target '{}': expected {}", name,
                            fmt::join(base::simd_targets(), ", ")));
  }
}

/// `mc` without a command: --version, --help, or nothing at all.
int run_top(const std::vector<std::string>& words) {
  TopArgs args;
  parse_words("", options_of(args), nullptr, words);
  if (args.common.help) {
    print_out(help_text("", args.common.verbose > 0));
  } else if (args.version) {
    print_out(version_text(args.common.verbose > 0));
  } else {
    throw Error(ErrorKind::usage, {},
                fmt::format("no command: expected {}", base::enumerate(command_names())),
                "see mc --help");
  }
  return 0;
}

int dispatch(Invocation& invocation, const std::vector<std::string>& words) {
  obey_simd_environment();
  const auto at = std::find_if(words.begin(), words.end(),
                               [](const std::string& word) { return !word.starts_with('-'); });
  if (at == words.end()) return run_top(words);
  // Options before the command are the command's own: `mc -v extract ...`.
  std::vector<std::string> rest(words.begin(), at);
  rest.insert(rest.end(), at + 1, words.end());
  for (const auto& [name, command] : kCommands) {
    if (name == *at) return command(invocation, std::move(rest));
  }
  const auto names = command_names();
  throw Error(ErrorKind::usage, *at,
              fmt::format("no such command: expected {}", base::enumerate(names)),
              suggestion(*at, names));
}

}  // namespace

int run_program(const std::vector<std::string>& words) {
  Invocation invocation;
  std::optional<SignalThread> signals;
  int status = 0;
  const auto failure = attempt([&] {
    signals.emplace(invocation.stop);  // before any other thread
    status = dispatch(invocation, words);
  });
  return failure ? show(invocation.console, *failure) : status;
}

}  // namespace mc::cli
