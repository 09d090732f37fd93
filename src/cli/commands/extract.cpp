// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <optional>

#include "base/machine_memory.hpp"
#include "base/parallel.hpp"
#include "cli/arguments/command_line.hpp"
#include "cli/commands/batch.hpp"
#include "cli/invocation.hpp"
#include "cli/messages/help.hpp"
#include "cli/messages/report.hpp"
#include "cli/messages/report_file.hpp"

// `mc extract`: volumes to meshes, one or a batch of them.

namespace mc::cli {

namespace {

/// A command line that is wrong is reported too, as far as it can be read.
int report_usage(const ExtractArgs& args, Invocation& invocation, const Failure& failure) {
  RunReport report;
  report.status = show(invocation.console, failure);
  report.error = fmt::format("{}", fmt::join(failure.lines, "\n"));
  report.peak_bytes = base::resident_bytes();
  if (!args.source.inputs.empty()) report.done.input = args.source.inputs.front();
  report.output = args.output;
  const bool clash = args.out.report && args.out.report == args.output;
  if (args.out.report && !args.out.report->empty() && !clash) {
    ReportFile file(args.out.report, invocation.stop.get_token());
    file.add_line(to_json(report));
    file.finish();
  }
  return failure.status;
}

}  // namespace

int run_extract(Invocation& invocation, std::vector<std::string> words) {
  ExtractArgs args;
  args.common.typed = words;
  const std::vector<Option> options = options_of(args);
  parse_words("extract", options, &args.source.inputs, std::move(words));
  if (args.common.help) {
    print_out(help_text("extract", args.common.verbose > 0));
    return 0;
  }
  ExtractPlan plan;
  if (const auto failure = attempt([&] { plan = resolve(args); })) {
    return report_usage(args, invocation, *failure);
  }
  invocation.console.configure(plan.common);
  std::optional<base::ThreadLimit> limit;
  if (plan.common.threads > 0) limit.emplace(plan.common.threads);
  ReportFile file(plan.report, invocation.stop.get_token());
  const int status = run_jobs(plan, invocation, file);
  file.finish();
  return status;
}

}  // namespace mc::cli
