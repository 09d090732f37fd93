// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "base/parallel.hpp"
#include "cli/command_line.hpp"
#include "cli/edit_session.hpp"
#include "cli/help.hpp"
#include "cli/invocation.hpp"

// `mc edit`: a volume, changed by a script of brush edits, to meshes and volumes.

namespace mc::cli {

int run_edit(Invocation& invocation, std::vector<std::string> words) {
  EditArgs args;
  args.mesh.common.typed = words;
  parse_words("edit", options_of(args), &args.mesh.source.inputs, std::move(words));
  if (args.mesh.common.help) {
    print_out(help_text("edit", args.mesh.common.verbose > 0));
    return 0;
  }
  EditPlan plan = resolve(args);
  const CommonOptions common = plan.surface.common;
  invocation.console.configure(common);
  std::optional<base::ThreadLimit> limit;
  if (common.threads > 0) limit.emplace(common.threads);
  EditSession session(args, std::move(plan), invocation);
  int status = 0;
  std::optional<std::string> error;
  if (const auto failure = attempt([&] { status = session.run(); })) {
    status = show(invocation.console, *failure);
    error = fmt::format("{}", fmt::join(failure->lines, "\n"));
  }
  // A stdout that took no more takes no last line either: that is told once.
  const auto last = attempt([&] { session.close_report(status, error); });
  if (!last) return status;
  const std::string text = fmt::format("{}", fmt::join(last->lines, "\n"));
  return text == error ? status : show(invocation.console, *last);
}

}  // namespace mc::cli
