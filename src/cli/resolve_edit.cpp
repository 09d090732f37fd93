// SPDX-License-Identifier: MIT
#include "cli/resolve_edit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "cli/command_line.hpp"
#include "cli/format_lists.hpp"
#include "cli/values.hpp"

// Every output is resolved as `mc extract` or `mc sample` would resolve it.

namespace mc::cli {

namespace {

[[noreturn]] void refuse(std::string_view option, std::string_view fault,
                         std::string_view remedy = {}) {
  throw Error(ErrorKind::usage, option, fault, remedy);
}

/// Of several outputs only stdout needs --to, the others say by their names what they are.
const SinkFormat& format_of(const EditArgs& args, const std::string& path) {
  SinkOptions options;
  if (args.mesh.to && (path == "-" || args.outputs.size() < 2)) options.to = *args.mesh.to;
  return output_format(path, options);
}

EditOutput resolve_output(const EditArgs& args, const std::string& path, const SinkFormat& format) {
  if (format.open_mesh != nullptr) {
    ExtractArgs mesh = args.mesh;
    mesh.output = path;
    mesh.to = format.name;
    return {path, resolve(mesh)};
  }
  if (format.open_volume == nullptr) {
    const Names whole = sink_names(
        [](const SinkFormat& f) { return f.open_volume != nullptr && f.open_picture == nullptr; });
    refuse(path, fmt::format("{} holds one slice of a volume", format.name),
           fmt::format("write {}, then use mc sample", sink::dotted(whole)));
  }
  SampleArgs volume;
  volume.source = args.mesh.source;
  volume.common = args.mesh.common;
  volume.output = path;
  volume.to = format.name;
  volume.region = args.mesh.region;
  volume.memory = args.mesh.memory;
  volume.force = args.mesh.force;
  return {path, resolve(volume)};
}

void check_input(const EditArgs& args) {
  if (args.mesh.source.inputs.empty()) {
    refuse("edit", "no input: expected a file, a folder, or - for stdin", "see mc edit --help");
  }
  if (!args.script) {
    refuse("edit", "no script: expected --script FILE, or - for stdin",
           fmt::format("for example: mc edit {} --script edits.json",
                       shell_text(args.mesh.common.typed)));
  }
  if (args.script->empty()) refuse("--script", "the script's name is empty");
  if (*args.script == "-" && std::ranges::count(args.mesh.source.inputs, "-") != 0) {
    refuse("--script", "stdin cannot be the input and the script", "give one of them as a file");
  }
}

void resolve_emit(const EditArgs& args, EditPlan& plan) {
  static constexpr std::array<std::pair<std::string_view, bool>, 1> kWhat{{{"chunks", true}}};
  plan.emits = args.emit && parse_choice("--emit", *args.emit, kWhat);
  plan.chunk_dir = args.chunk_dir;
  for (const auto& [option, given] : {std::pair{"--emit-at", args.emit_at.has_value()},
                                      {"--chunk-dir", args.chunk_dir.has_value()},
                                      {"--chunk-cells", args.chunk_cells.has_value()}}) {
    if (given && !plan.emits) refuse(option, "is of the chunks that --emit chunks hands out");
  }
  static constexpr std::array<std::pair<std::string_view, bool>, 2> kWhen{
      {{"record", false}, {"write", true}}};
  plan.emits_at_writes = args.emit_at && parse_choice("--emit-at", *args.emit_at, kWhen);
  if (plan.chunk_dir && plan.chunk_dir->empty())
    refuse("--chunk-dir", "the folder's name is empty");
  if (!args.chunk_cells) return;
  static constexpr std::array<std::pair<std::string_view, std::int32_t>, 6> kCells{
      {{"8", 8}, {"16", 16}, {"32", 32}, {"64", 64}, {"128", 128}, {"256", 256}}};
  plan.chunk_cells = parse_choice("--chunk-cells", *args.chunk_cells, kCells);
}

/// Chunks on stdout may be asked for by `-o -`, which then is no mesh.
std::vector<std::string> outputs_of(const EditArgs& args, const EditPlan& plan) {
  std::vector<std::string> outputs = args.outputs;
  if (!plan.sends_chunks() || std::ranges::count(outputs, "-") != 1) return outputs;
  if (args.mesh.to && *args.mesh.to != chunk_format().name) {
    refuse("--to", fmt::format("chunks on stdout are {}", chunk_format().name));
  }
  std::erase(outputs, "-");
  return outputs;
}

/// stdout has room for one thing.
void check_streams(const EditArgs& args, const EditPlan& plan) {
  const auto on_stdout = std::ranges::count(args.outputs, "-");
  if (on_stdout > 1) refuse("--output", "- is given more than once");
  if (on_stdout != 0 && plan.lines_on_stdout()) {
    refuse("--report",
           plan.report ? "cannot go to stdout with --output -"
                       : "missing: the lines of --emit cannot go to stdout with --output -",
           plan.report ? "give another FILE" : "give a FILE");
  }
  for (const auto& [option, path] :
       {std::pair{"--report", plan.report}, {"--journal", plan.journal}}) {
    if (!path) continue;
    if (path->empty()) refuse(option, "the file's name is empty");
    if (*path == "-") continue;
    if (*path == args.script || std::ranges::count(args.outputs, *path) != 0 ||
        std::ranges::count(args.mesh.source.inputs, *path) != 0) {
      refuse(option, "names an input or output itself", "give another FILE");
    }
  }
  if (plan.journal == "-") refuse("--journal", "cannot go to stdout", "give a FILE");
  if (plan.journal && plan.journal == plan.report) refuse("--journal", "names the report itself");
}

}  // namespace

EditOutput resolve_write(const EditArgs& args, const std::string& path) {
  return resolve_output(args, path, output_format(path, {}));
}

EditPlan resolve(const EditArgs& typed) {
  check_input(typed);
  EditPlan plan;
  resolve_emit(typed, plan);
  EditArgs args = typed;
  args.outputs = outputs_of(typed, plan);
  plan.script = *args.script;
  plan.journal = args.journal;
  plan.report = args.mesh.report;
  plan.keep_going = args.keep_going;
  plan.dry_run = args.mesh.dry_run;
  check_streams(args, plan);
  for (const std::string& path : args.outputs) {
    if (path.empty()) refuse("--output", "the output's name is empty");
    if (std::ranges::count(args.outputs, path) > 1) {
      refuse("--output", fmt::format("{} is given more than once", path));
    }
    plan.outputs.push_back(resolve_output(args, path, format_of(args, path)));
  }
  ExtractArgs surface = args.mesh;
  surface.output = fmt::format("chunk.{}", chunk_format().name);
  surface.to = chunk_format().name;
  surface.ascii = false;
  surface.precision.reset();
  plan.surface = resolve(surface);
  plan.surface.report = plan.report;
  if (plan.emits && plan.surface.isos.size() > 1) {
    refuse("--iso", "chunks are of one surface, but more than one value is given");
  }
  if (args.undo) {
    plan.undo = static_cast<std::size_t>(
        parse_integer("--undo", *args.undo, 0, std::numeric_limits<std::int32_t>::max()));
  }
  return plan;
}

}  // namespace mc::cli
