// SPDX-License-Identifier: MIT
#include "mc/convert.hpp"

#include <fmt/format.h>

#include "convert/mesh_run.hpp"
#include "convert/notes.hpp"
#include "convert/watching_inputs.hpp"

// The doors of the room: what a conversion does is decided by the output's format.

namespace mc {

namespace {

void copy_volume(std::span<const std::string> inputs, const std::string& output,
                 const ConvertOptions& options, Progress& progress, const std::stop_token& stop,
                 ConvertReport& report) {
  SourceOptions from = options.source;
  // All planes are written in order; a slice or a region is not all of them.
  from.streams = !options.extract.region && !options.slice;
  from.memory_bytes = options.memory_bytes;
  const Source source = open_source(inputs, from, progress);
  report.input = source.place;
  report.volume = volume_of(source.reader);
  conversion::note_chosen_grid(source, from, progress);
  if (options.dry_run) return check_region(source.reader, options.extract.region);
  const VolumeOptions volume = volume_options(options);
  if (options.slice) {
    write_slice(source.reader, output, *options.slice, volume, progress, stop);
  } else {
    write_volume(source.reader, output, volume, progress, stop);
  }
}

}  // namespace

void convert(std::span<const std::string> inputs, const std::string& output,
             const ConvertOptions& options, Progress& progress, const std::stop_token& stop,
             ConvertReport& report) {
  report = {};
  report.input = inputs.front();
  const SinkFormat& format = output_format(output, options.sink);
  report.format = format.name;
  conversion::watching_inputs([&] {
    if (format.open_mesh == nullptr) {
      return copy_volume(inputs, output, options, progress, stop, report);
    }
    conversion::MeshRun run(output, options, progress, stop, report);
    run.open(inputs);
    run.run(std::nullopt);
  });
}

ConvertReport convert(std::span<const std::string> inputs, const std::string& output,
                      const ConvertOptions& options, Progress& progress,
                      const std::stop_token& stop) {
  ConvertReport report;
  convert(inputs, output, options, progress, stop, report);
  return report;
}

ConvertReport convert(const std::string& input, const std::string& output,
                      const ConvertOptions& options, Progress& progress,
                      const std::stop_token& stop) {
  return convert({&input, 1}, output, options, progress, stop);
}

void write_mesh(const Source& source, const std::optional<Surface>& surface,
                const std::string& output, const ConvertOptions& options, Progress& progress,
                const std::stop_token& stop, ConvertReport& report) {
  report = {};
  conversion::MeshRun run(output, options, progress, stop, report);
  run.use(source);
  run.run(surface);
}

}  // namespace mc
