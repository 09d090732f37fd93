// SPDX-License-Identifier: MIT
#include <optional>

#include "base/parallel.hpp"
#include "cli/arguments/command_line.hpp"
#include "cli/arguments/resolve.hpp"
#include "cli/invocation.hpp"
#include "cli/messages/help.hpp"
#include "cli/messages/summary.hpp"
#include "convert/notes.hpp"
#include "mc/convert.hpp"

// `mc sample`: any volume to a volume file, or one slice of it to a picture.

namespace mc::cli {

namespace {

void write_one_slice(const SamplePlan& plan, Invocation& invocation) {
  const Source source = open_source(plan.job.inputs, plan.source, invocation.console);
  conversion::note_chosen_grid(source, plan.source, invocation.console);
  write_slice(source.reader, plan.job.output, *plan.slice, plan.volume, invocation.console,
              invocation.stop.get_token());
}

}  // namespace

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
  const std::stop_token stop = invocation.stop.get_token();
  Summary summary;
  if (!plan.slice) {
    ConvertOptions options{.source = plan.source, .sink = plan.volume.sink};
    options.extract.region = plan.volume.region;
    options.memory_bytes = plan.volume.memory_bytes;
    const ConvertReport report =
        convert(plan.job.inputs, plan.job.output, options, invocation.console, stop);
    summary.add_samples(plan.volume.region.value_or(report.volume->lattice.box));
  } else {
    write_one_slice(plan, invocation);
  }
  if (plan.job.output != "-" && invocation.console.shows_summary()) {
    summary.add_file(plan.job.output);
    invocation.console.note(summary.text(plan.job.output));
  }
  return 0;
}

}  // namespace mc::cli
