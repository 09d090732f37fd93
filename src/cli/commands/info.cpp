// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/parallel.hpp"
#include "base/text.hpp"
#include "cli/arguments/command_line.hpp"
#include "cli/arguments/resolve.hpp"
#include "cli/arguments/values.hpp"
#include "cli/invocation.hpp"
#include "cli/messages/help.hpp"
#include "cli/messages/report.hpp"
#include "convert/output_frame.hpp"
#include "mc/convert.hpp"
#include "mc/host.hpp"

// `mc info`: what an input holds, and what extract would do with it.

namespace mc::cli {

namespace {

/// A picture by its name.
bool is_picture(const std::string& input) {
  const std::string extension = std::filesystem::path(input).extension().string();
  return !extension.empty() &&
         std::ranges::any_of(source_formats(), [&](const SourceFormat* format) {
           return format->several_files && !format->headerless &&
                  base::has_word(format->extensions, extension.substr(1));
         });
}

/// One input: a file, or the slices of one volume.
std::vector<std::vector<std::string>> grouped(const SourceArgs& args) {
  if (args.type || std::ranges::all_of(args.inputs, is_picture)) return {args.inputs};
  std::vector<std::vector<std::string>> groups;
  for (const std::string& input : args.inputs) groups.push_back({input});
  return groups;
}

/// What is wanted to know, and within which memory.
struct Wish {
  bool memory_estimate = false;
  std::uint64_t memory_bytes = 0;
};

/// What sinks of binary formats make of a chunk.
Formatted any_binary(bool f32_moves) {
  Formatted most;
  for (const SinkFormat* format : sink_formats()) {
    if (format->open_mesh == nullptr || format->text == TextForm::always) continue;
    const Formatted one = format->needs({}, f32_moves).formatted;
    most.vertex_bytes = std::max(most.vertex_bytes, one.vertex_bytes);
    most.triangle_bytes = std::max(most.triangle_bytes, one.triangle_bytes);
  }
  return most;
}

/// Of a mesh at the suggested iso by mc-extract(1), in any binary format.
MemoryNeed estimate(const VolumeReader& reader, const Surface& surface, bool streamed,
                    const Wish& wish, Invocation& invocation) {
  const Volume& volume = volume_of(reader);
  RunOptions options;
  options.extract.iso = surface.isos.front().value;
  options.extract.inside = surface.inside;
  options.extract.border = surface.border;
  options.extract.normals = Normals::gradient;
  options.memory_bytes = wish.memory_bytes;
  const Lattice& lattice = volume.lattice;
  const bool f32_moves =
      conversion::rounding_loss(lattice.box, lattice.to_world, Precision::f32).matters;
  options.extract.precision = f32_moves ? Precision::f64 : Precision::f32;
  options.formatted = any_binary(f32_moves);
  return memory_counted(reader, options, invocation.stop.get_token(), streamed);
}

void measure_grid(VolumeReader reader, bool piped, const Wish& wish, GridInfo& grid,
                  Invocation& invocation) {
  const bool streams = spool_stream(reader, invocation.console);
  const Volume& volume = volume_of(reader);
  const bool streamed_by_extract = streams || (piped && find_source_format(volume.format)->streams);
  grid.statistics = measure_field(reader, kInfoPercentiles, invocation.console,
                                  invocation.stop.get_token(), wish.memory_bytes);
  invocation.console.end_stage();
  const Surface surface = default_surface(volume, &*grid.statistics);
  const Iso& iso = surface.isos.front();
  grid.iso = iso.value;
  grid.iso_reason = iso.reason;
  if (!wish.memory_estimate || !std::isfinite(iso.value)) return;
  grid.memory = estimate(reader, surface, streamed_by_extract, wish, invocation);
}

/// A FIFO, or what a shell puts in place of <(command): it gives its bytes once.
bool opens_once(const std::string& input) {
  std::error_code ignored;
  const auto status = std::filesystem::status(input, ignored);
  return input != "-" && std::filesystem::is_fifo(status);
}

/// Whether stdin is the input, and no file.
bool is_piped(const std::string& input) {
  struct stat status {};
  return input == "-" && ::fstat(STDIN_FILENO, &status) == 0 && !S_ISREG(status.st_mode);
}

/// The one grid that is taken of what opens once.
void inspect_once(const std::vector<std::string>& inputs, const SourceOptions& options,
                  const Wish& wish, Invocation& invocation, InputInfo& info) {
  SourceOptions once = options;
  once.streams = true;
  Source source = open_source(inputs, once, invocation.console);
  const Volume& volume = volume_of(source.reader);
  info.grids.push_back({{volume, sample_name(volume.type), ""}, {}, 0, {}, {}});
  measure_grid(std::move(source.reader), false, wish, info.grids.front(), invocation);
  if (!source.other_grids.empty()) {
    invocation.console.note(fmt::format("{}: holds other grids too: {}; a FIFO shows one",
                                        info.place, fmt::join(source.other_grids, ", ")));
  }
}

/// Grids in the file's order; `#n` names the n-th of them whatever its name.
void inspect(const std::vector<std::string>& inputs, const SourceOptions& options, const Wish& wish,
             Invocation& invocation, InputInfo& info) {
  info.place = inputs.front() == "-" ? "<stdin>" : inputs.front();
  if (inputs.size() == 1 && opens_once(inputs.front())) {
    inspect_once(inputs, options, wish, invocation, info);
    return;
  }
  const bool piped = is_piped(inputs.front());
  const auto grids = describe_source(inputs, options, invocation.console);
  for (const GridDescription& description : grids) {
    info.grids.push_back({description, {}, 0, {}, {}});
  }
  for (std::size_t n = 0; n < info.grids.size(); ++n) {
    if (!info.grids[n].description.refused.empty()) continue;
    SourceOptions one = options;
    one.streams = true;
    if (grids.size() > 1) one.grid = fmt::format("#{}", n);
    measure_grid(open_source(inputs, one, invocation.console).reader, piped, wish, info.grids[n],
                 invocation);
  }
}

std::string triple(double x, double y, double z) { return fmt::format("{} {} {}", x, y, z); }

std::string value_lines(const GridInfo& grid) {
  const FieldStatistics& s = *grid.statistics;
  const SampleType type = grid.description.volume.type;
  std::string text;
  text +=
      fmt::format("  range        {} to {}\n", value_text(s.min, type), value_text(s.max, type));
  if (s.n_nan > 0) text += fmt::format("  nan          {} of {}\n", s.n_nan, s.n_samples);
  if (s.n_infinite > 0) text += fmt::format("  infinite     {} of {}\n", s.n_infinite, s.n_samples);
  text += "  percentiles ";
  for (std::size_t n = 0; n < s.percentiles.size(); ++n) {
    text += fmt::format(" p{} {}", kInfoPercentiles[n], value_text(s.percentiles[n], type));
  }
  text += fmt::format("\n  iso          {} ({})\n", value_text(grid.iso, type), grid.iso_reason);
  if (grid.memory) text += fmt::format("  memory       {}\n", memory_text(*grid.memory));
  return text;
}

std::string grid_lines(const GridInfo& grid) {
  const GridDescription& description = grid.description;
  const Volume& v = description.volume;
  std::string text =
      fmt::format("  grid         {}\n", v.name.empty() ? std::string("(unnamed)") : v.name);
  text += fmt::format("  type         {}{}\n", description.type_name,
                      v.stored_as.empty() ? "" : fmt::format(", stored as {}", v.stored_as));
  if (!description.refused.empty()) {
    return text + fmt::format("  not meshed   {}\n", description.refused);
  }
  const IndexBox& box = v.lattice.box;
  text += fmt::format("  class        {}\n", name_of(v.cls));
  text += fmt::format("  dims         {} x {} x {}\n", box.extent(0), box.extent(1), box.extent(2));
  if (box.lo != Index3{}) {
    text += fmt::format("  first index  {} {} {}\n", box.lo[0], box.lo[1], box.lo[2]);
  }
  if (v.n_active) text += fmt::format("  active       {}\n", *v.n_active);
  const Affine& map = v.lattice.to_world;
  text +=
      fmt::format("  spacing      {}\n", triple(map.spacing(0), map.spacing(1), map.spacing(2)));
  text += fmt::format("  origin       {}\n", triple(map.m[3], map.m[7], map.m[11]));
  text += fmt::format("  frame        {}, units {}\n", name_of(v.frame), name_of(v.units));
  return grid.statistics ? text + value_lines(grid) : text;
}

std::string lines(const InputInfo& info) {
  std::string text = fmt::format(
      "{}: {}, {} {}\n", info.place,
      info.grids.empty() ? std::string("empty") : info.grids.front().description.volume.format,
      info.grids.size(), info.grids.size() == 1 ? "grid" : "grids");
  for (std::size_t n = 0; n < info.grids.size(); ++n) {
    if (n > 0) text += '\n';
    text += grid_lines(info.grids[n]);
  }
  return text;
}

}  // namespace

int run_info(Invocation& invocation, std::vector<std::string> words) {
  InfoArgs args;
  parse_words("info", options_of(args), &args.source.inputs, std::move(words));
  if (args.common.help) {
    print_out(help_text("info", args.common.verbose > 0));
    return 0;
  }
  if (args.source.inputs.empty()) {
    throw Error(ErrorKind::usage, "info", "no input: expected a file, a folder, or - for stdin",
                "see mc info --help");
  }
  const CommonOptions common = resolve_common(args.common);
  const Wish wish{args.memory_estimate || args.common.verbose > 0, resolve_memory(args.memory)};
  SourceOptions source = resolve_source(args.source);
  source.memory_bytes = wish.memory_bytes;
  invocation.console.configure(common);
  std::optional<base::ThreadLimit> limit;
  if (common.threads > 0) limit.emplace(common.threads);
  int status = 0;
  bool first = true;
  for (const auto& inputs : grouped(args.source)) {
    InputInfo info;
    const auto failure = attempt([&] {
      inspect(inputs, source, wish, invocation, info);
      refuse_changed_inputs();
    });
    if (failure) {
      const int this_status = show(invocation.console, *failure);
      if (status == 0) status = this_status;
      info.error = fmt::format("{}", fmt::join(failure->lines, "\n"));
    }
    if (args.json) {
      print_out(to_json(info) + "\n");
    } else if (!failure) {
      print_out((first ? "" : "\n") + lines(info));
    }
    first = false;
  }
  return status;
}

}  // namespace mc::cli
