// SPDX-License-Identifier: MIT
#include <optional>

#include "base/parallel.hpp"
#include "cli/chosen_grid.hpp"
#include "cli/command_line.hpp"
#include "cli/help.hpp"
#include "cli/invocation.hpp"
#include "cli/region.hpp"
#include "cli/resolve.hpp"
#include "cli/slice.hpp"
#include "cli/volume_job.hpp"

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
  SamplePlan plan = resolve(args);
  plan.sink.provenance.emplace_back("generator", "mc " MC_VERSION);
  invocation.console.configure(plan.common);
  std::optional<base::ThreadLimit> limit;
  if (plan.common.threads > 0) limit.emplace(plan.common.threads);
  // All planes are written in order; a slice or a region is not all of them.
  plan.source.streams = !plan.slice && !plan.region;
  plan.source.memory_bytes = plan.memory_bytes;
  const Source source = open_source(plan.job.inputs, plan.source, invocation.console);
  note_chosen_grid(source, plan.source, invocation.console);
  check_region(source.reader, plan.region);
  if (plan.slice) {
    write_slice(source.reader, plan, invocation);
  } else {
    write_volume(source.reader, plan, invocation);
  }
  return 0;
}

}  // namespace mc::cli
