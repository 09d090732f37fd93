// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <memory>
#include <type_traits>
#include <vector>

#include "base/parallel.hpp"
#include "convert/planes_per_read.hpp"
#include "convert/provenance.hpp"
#include "mc/convert.hpp"
#include "mc/host.hpp"

// Plane by plane, or whole where both ends are sparse.

namespace mc {

namespace {

/// Where planes go, and within what.
struct Target {
  VolumeSink& sink;
  const std::string& output;
  std::uint64_t memory_bytes;
  Progress& progress;
  const std::stop_token& stop;
};

/// All planes, in order, while others are read; the sink has begun. The planes of a reader are read
/// by all threads, those of a stream one after the other.
template <class Planes>
void write_planes(Planes& planes, std::uint64_t held_bytes, const Target& to) {
  const Volume& volume = planes.volume();
  const auto n_planes = static_cast<std::int32_t>(volume.lattice.box.extent(2));
  const std::int32_t at_once =
      conversion::planes_per_read(volume, memory_beside(held_bytes, to.memory_bytes), to.output);
  const std::size_t n_slots = std::min(base::pipeline_slots(), static_cast<std::size_t>(at_once));
  const std::int32_t per_item = at_once / static_cast<std::int32_t>(n_slots);
  std::vector<Slab> slabs(n_slots);
  const auto read = [&](std::size_t item, std::size_t slot) {
    if (to.stop.stop_requested()) throw Cancelled();
    const std::int32_t k = static_cast<std::int32_t>(item) * per_item;
    planes.read(k, std::min(n_planes, k + per_item), slabs[slot]);
  };
  const auto write = [&](std::size_t /*item*/, std::size_t slot) {
    to.sink.write(slabs[slot]);
    to.progress.advance(slabs[slot].planes.size());
  };
  constexpr bool kReadsInOrder = std::is_same_v<Planes, PlaneStream>;
  const std::array<base::Step, 2> steps{{{kReadsInOrder, read}, {true, write}}};
  to.progress.begin("sample", static_cast<std::uint64_t>(n_planes), "planes");
  base::pipeline(static_cast<std::size_t>((n_planes + per_item - 1) / per_item), n_slots, steps);
}

void write_all(const SlabReader& reader, const Target& to) {
  to.sink.begin(reader.volume());
  write_planes(reader, reader.held_bytes(), to);
}

void write(const SlabReader& reader, const std::optional<IndexBox>& region, const Target& to) {
  if (region) {
    write_all(*crop_view(reader, *region), to);
  } else {
    write_all(reader, to);
  }
}

void write(PlaneStream& stream, const std::optional<IndexBox>& region, const Target& to) {
  if (region) {
    throw Error(ErrorKind::usage, to.output, "a region of a stream: copy the stream to disk first");
  }
  to.sink.begin(stream.volume());
  write_planes(stream, 0, to);
}

void write(const LeafReader& reader, const std::optional<IndexBox>& region, const Target& to) {
  if (region) return write_all(*dense_view(reader, *region), to);
  to.sink.begin(reader.volume());
  if (to.sink.write_sparse(reader)) return;
  const auto view = dense_view(reader, reader.volume().lattice.box);
  write_planes(*view, view->held_bytes(), to);
}

}  // namespace

VolumeOptions volume_options(const ConvertOptions& options) {
  return {options.sink, options.extract.region, options.memory_bytes};
}

void write_volume(const VolumeReader& from, const std::string& output, const VolumeOptions& options,
                  Progress& progress, const std::stop_token& stop) {
  check_region(from, options.region);
  SinkOptions into = options.sink;
  into.progress = &progress;
  into.provenance.push_back(conversion::generator());
  const std::unique_ptr<VolumeSink> sink = open_volume_sink(output, into);
  const Target to{*sink, output, options.memory_bytes, progress, stop};
  std::visit([&](const auto& reader) { write(*reader, options.region, to); }, from);
  refuse_changed_inputs();
  sink->finish();
  progress.end_stage();
}

}  // namespace mc
