// SPDX-License-Identifier: MIT
#include "cli/volume_job.hpp"

#include <algorithm>
#include <memory>

#include "cli/planes_a_read.hpp"
#include "mc/sink.hpp"
#include "mc/source.hpp"

// Plane by plane, or whole where both ends are sparse.

namespace mc::cli {

namespace {

/// All planes of a reader or stream, in order; the sink has begun.
template <class Planes>
void write_planes(Planes& planes, std::uint64_t held_bytes, const SamplePlan& plan,
                  VolumeSink& sink, Invocation& invocation) {
  const Volume& volume = planes.volume();
  const auto n_planes = static_cast<std::int32_t>(volume.lattice.box.extent(2));
  const std::int32_t step =
      planes_a_read(volume, memory_beside(held_bytes, plan.memory_bytes), plan.job.output);
  invocation.console.begin("sample", static_cast<std::uint64_t>(n_planes), "planes");
  Slab slab;
  for (std::int32_t k = 0; k < n_planes; k += step) {
    if (invocation.stop.stop_requested()) throw Cancelled();
    const std::int32_t end = std::min(n_planes, k + step);
    planes.read(k, end, slab);
    sink.write(slab);
    invocation.console.advance(static_cast<std::uint64_t>(end - k));
  }
}

void write_part(const SlabReader& part, const SamplePlan& plan, VolumeSink& sink,
                Invocation& invocation) {
  sink.begin(part.volume());
  write_planes(part, part.held_bytes(), plan, sink, invocation);
}

void write(const SlabReader& reader, const SamplePlan& plan, VolumeSink& sink,
           Invocation& invocation) {
  if (plan.region) {
    write_part(*crop_view(reader, *plan.region), plan, sink, invocation);
  } else {
    write_part(reader, plan, sink, invocation);
  }
}

void write(PlaneStream& stream, const SamplePlan& plan, VolumeSink& sink, Invocation& invocation) {
  sink.begin(stream.volume());
  write_planes(stream, 0, plan, sink, invocation);
}

void write(const LeafReader& reader, const SamplePlan& plan, VolumeSink& sink,
           Invocation& invocation) {
  if (plan.region) {
    write_part(*dense_view(reader, *plan.region), plan, sink, invocation);
    return;
  }
  sink.begin(reader.volume());
  if (!sink.write_sparse(reader)) {
    const auto view = dense_view(reader, reader.volume().lattice.box);
    write_planes(*view, view->held_bytes(), plan, sink, invocation);
  }
}

}  // namespace

void write_volume(const VolumeReader& from, const SamplePlan& plan, Invocation& invocation) {
  SinkOptions options = plan.sink;
  options.progress = &invocation.console;
  const std::unique_ptr<VolumeSink> sink = open_volume_sink(plan.job.output, options);
  std::visit([&](const auto& reader) { write(*reader, plan, *sink, invocation); }, from);
  refuse_changed_inputs();
  sink->finish();
  invocation.console.end_stage();
}

}  // namespace mc::cli
