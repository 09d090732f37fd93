// SPDX-License-Identifier: MIT
#include <optional>

#include "base/parallel.hpp"
#include "cli/arguments/command_line.hpp"
#include "cli/arguments/resolve.hpp"
#include "cli/invocation.hpp"
#include "cli/messages/help.hpp"
#include "cli/messages/summary.hpp"
#include "mc/convert.hpp"

// `mc sample`: any volume to a volume file, or one slice of it to a picture.

namespace mc::cli {

int run_sample(Invocation& invocation, std::vector<std::string> words) {
  SampleArgs args;
  args.common.typed = words;
  parse_words("sample", options_of(args), &args.source.inputs, std::move(words));
  if (args.common.help) {
    print_out(help_text("sample", args.common.verbose > 0));
    return 0;
  }
  const SamplePlan plan = resolve(args);
  invocation.console.configure(plan.common);
  std::optional<base::ThreadLimit> limit;
  if (plan.common.threads > 0) limit.emplace(plan.common.threads);
  Summary summary;
  const ConvertReport report = convert(plan.job.inputs, plan.job.output, plan.convert,
                                       invocation.console, invocation.stop.get_token());
  if (!plan.convert.slice) {
    summary.add_samples(plan.convert.extract.region.value_or(report.volume->lattice.box));
  }
  if (plan.job.output != "-" && invocation.console.shows_summary()) {
    summary.add_file(plan.job.output);
    invocation.console.note(summary.text(plan.job.output));
  }
  return 0;
}

}  // namespace mc::cli
