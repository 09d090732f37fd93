// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "base/parallel.hpp"
#include "cli/command_line.hpp"
#include "cli/help.hpp"
#include "cli/invocation.hpp"
#include "cli/region.hpp"
#include "cli/resolve.hpp"
#include "cli/values.hpp"

// `mc sample`: any volume to a volume file, plane by plane, or whole where both ends are sparse.

namespace mc::cli {

namespace {

/// Planes a read: many enough to share among threads, few enough to stay within the budget, which
/// the reader's copy and the sink's share.
std::int32_t planes_a_read(const Volume& volume, std::uint64_t memory_bytes,
                           std::string_view place) {
  const IndexBox& box = volume.lattice.box;
  const std::uint64_t plane_bytes = static_cast<std::uint64_t>(box.extent(0)) *
                                    static_cast<std::uint64_t>(box.extent(1)) *
                                    sample_size(volume.type);
  const std::uint64_t n_planes = memory_bytes / 2 / std::max<std::uint64_t>(plane_bytes, 1);
  if (n_planes == 0) {
    throw Error(ErrorKind::limit, place,
                fmt::format("two planes of samples need {}, but --memory allows {}",
                            size_text(2 * plane_bytes), size_text(memory_bytes)),
                "raise --memory, or choose a --region");
  }
  return static_cast<std::int32_t>(std::min<std::uint64_t>(n_planes, 32));
}

/// All planes in order; the sink has begun.
void write_planes(const SlabReader& reader, const SamplePlan& plan, VolumeSink& sink,
                  Invocation& invocation) {
  const Volume& volume = reader.volume();
  const auto n_planes = static_cast<std::int32_t>(volume.lattice.box.extent(2));
  const std::int32_t step = planes_a_read(volume, plan.memory_bytes, plan.job.output);
  invocation.console.begin("sample", static_cast<std::uint64_t>(n_planes), "planes");
  Slab slab;
  for (std::int32_t k = 0; k < n_planes; k += step) {
    if (invocation.stop.stop_requested()) throw Cancelled();
    const std::int32_t end = std::min(n_planes, k + step);
    reader.read(k, end, slab);
    sink.write(slab);
    invocation.console.advance(static_cast<std::uint64_t>(end - k));
  }
}

void write_part(const SlabReader& part, const SamplePlan& plan, VolumeSink& sink,
                Invocation& invocation) {
  sink.begin(part.volume());
  write_planes(part, plan, sink, invocation);
}

void write(const SlabReader& reader, const SamplePlan& plan, VolumeSink& sink,
           Invocation& invocation) {
  if (plan.region) {
    write_part(*crop_view(reader, *plan.region), plan, sink, invocation);
  } else {
    write_part(reader, plan, sink, invocation);
  }
}

void write(const LeafReader& reader, const SamplePlan& plan, VolumeSink& sink,
           Invocation& invocation) {
  if (plan.region) {
    write_part(*dense_view(reader, *plan.region), plan, sink, invocation);
    return;
  }
  sink.begin(reader.volume());
  if (!sink.write_sparse(reader)) {
    write_planes(*dense_view(reader, reader.volume().lattice.box), plan, sink, invocation);
  }
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
  SamplePlan plan = resolve(args);
  plan.sink.provenance.emplace_back("generator", "mc " MC_VERSION);
  invocation.console.configure(plan.common);
  std::optional<base::ThreadLimit> limit;
  if (plan.common.threads > 0) limit.emplace(plan.common.threads);
  const Source source = open_source(plan.job.inputs, plan.source, invocation.console);
  check_region(source.reader, plan.region);
  const std::unique_ptr<VolumeSink> sink = open_volume_sink(plan.job.output, plan.sink);
  std::visit([&](const auto& reader) { write(*reader, plan, *sink, invocation); }, source.reader);
  sink->finish();
  invocation.console.end_stage();
  return 0;
}

}  // namespace mc::cli
