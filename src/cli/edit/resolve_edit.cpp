// SPDX-License-Identifier: MIT
#include "cli/edit/resolve_edit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "cli/arguments/command_line.hpp"
#include "cli/arguments/format_lists.hpp"
#include "cli/arguments/values.hpp"
#include "convert/chunk_writer.hpp"

// Every output is resolved from the same typed pieces as those of `mc extract` and `mc sample`.

namespace mc::cli {

namespace {

[[noreturn]] void refuse(std::string_view option, std::string_view fault,
                         std::string_view remedy = {}) {
  throw Error(ErrorKind::usage, option, fault, remedy);
}

/// Of several outputs only stdout needs --to, the others say by their names what they are.
const SinkFormat& format_of(const EditArgs& args, const std::string& path) {
  SinkOptions options;
  if (args.out.to && (path == "-" || args.outputs.size() < 2)) options.to = *args.out.to;
  return output_format(path, options);
}

ScriptOutput resolve_output(const EditArgs& args, const std::string& path,
                            const SinkFormat& format) {
  if (format.open_mesh != nullptr) {
    check_streamable(path, format);
    return {path, resolve_conversion(resolve_source(args.source), args.surface, args.out, format)};
  }
  if (format.open_volume == nullptr) {
    const Names whole = sink_names(
        [](const SinkFormat& f) { return f.open_volume != nullptr && f.open_picture == nullptr; });
    refuse(path, fmt::format("{} holds one slice of a volume", format.name),
           fmt::format("write {}, then use mc sample", sink::dotted(whole)));
  }
  return {path, resolve_volume(args.surface.region, args.out.memory, args.out.force, args.out.sync,
                               format)};
}

/// How chunks are meshed and the input is opened.
ConvertOptions resolve_chunks(const EditArgs& args) {
  OutputArgs out = args.out;
  out.ascii = false;
  out.precision.reset();
  return resolve_conversion(resolve_source(args.source), args.surface, out,
                            conversion::chunk_format());
}

void check_input(const EditArgs& args) {
  if (args.source.inputs.empty()) {
    refuse("edit", "no input: expected a file, a folder, or - for stdin", "see mc edit --help");
  }
  if (!args.script) {
    refuse(
        "edit", "no script: expected --script FILE, or - for stdin",
        fmt::format("for example: mc edit {} --script edits.json", shell_text(args.common.typed)));
  }
  if (args.script->empty()) refuse("--script", "the script's name is empty");
  if (*args.script == "-" && std::ranges::count(args.source.inputs, "-") != 0) {
    refuse("--script", "stdin cannot be the input and the script", "give one of them as a file");
  }
}

std::optional<ChunkOutput> resolve_chunk_output(const EditArgs& args) {
  static constexpr std::array<std::pair<std::string_view, bool>, 1> kWhat{{{"chunks", true}}};
  const bool emits = args.emit && parse_choice("--emit", *args.emit, kWhat);
  for (const auto& [option, given] : {std::pair{"--emit-at", args.emit_at.has_value()},
                                      {"--chunk-dir", args.chunk_dir.has_value()},
                                      {"--chunk-cells", args.chunk_cells.has_value()}}) {
    if (given && !emits) refuse(option, "is of the chunks that --emit chunks hands out");
  }
  if (!emits) return std::nullopt;
  ChunkOutput chunks{.folder = args.chunk_dir};
  static constexpr std::array<std::pair<std::string_view, bool>, 2> kWhen{
      {{"record", false}, {"write", true}}};
  chunks.at_writes = args.emit_at && parse_choice("--emit-at", *args.emit_at, kWhen);
  if (chunks.folder && chunks.folder->empty()) {
    refuse("--chunk-dir", "the folder's name is empty");
  }
  static constexpr std::array<std::pair<std::string_view, std::int32_t>, 6> kCells{
      {{"8", 8}, {"16", 16}, {"32", 32}, {"64", 64}, {"128", 128}, {"256", 256}}};
  if (args.chunk_cells) {
    chunks.n_cells = parse_choice("--chunk-cells", *args.chunk_cells, kCells);
  }
  return chunks;
}

/// Chunks on stdout may be asked for by `-o -`, which then is no mesh.
std::vector<std::string> outputs_of(const EditArgs& args, const EditPlan& plan) {
  std::vector<std::string> outputs = args.outputs;
  if (!plan.sends_chunks() || std::ranges::count(outputs, "-") != 1) return outputs;
  if (args.out.to && *args.out.to != conversion::chunk_format().name) {
    refuse("--to", fmt::format("chunks on stdout are {}", conversion::chunk_format().name));
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
       {std::pair{"--report", plan.report}, {"--journal", plan.options.journal}}) {
    if (!path) continue;
    if (path->empty()) refuse(option, "the file's name is empty");
    if (*path == "-") continue;
    if (*path == args.script || std::ranges::count(args.outputs, *path) != 0 ||
        std::ranges::count(args.source.inputs, *path) != 0) {
      refuse(option, "names an input or output itself", "give another FILE");
    }
  }
  const std::optional<std::string>& journal = plan.options.journal;
  if (journal == "-") refuse("--journal", "cannot go to stdout", "give a FILE");
  if (journal && journal == plan.report) refuse("--journal", "names the report itself");
}

}  // namespace

EditPlan resolve(const EditArgs& typed) {
  check_input(typed);
  EditPlan plan;
  ScriptOptions& options = plan.options;
  options.chunks = resolve_chunk_output(typed);
  EditArgs args = typed;
  args.outputs = outputs_of(typed, plan);
  plan.inputs = args.source.inputs;
  plan.common = resolve_common(args.common);
  plan.script = *args.script;
  plan.report = args.out.report;
  options.journal = args.journal;
  options.keep_going = args.keep_going;
  options.limits_store = args.out.memory.has_value();
  check_streams(args, plan);
  for (const std::string& path : args.outputs) {
    if (path.empty()) refuse("--output", "the output's name is empty");
    if (std::ranges::count(args.outputs, path) > 1) {
      refuse("--output", fmt::format("{} is given more than once", path));
    }
    options.outputs.push_back(resolve_output(args, path, format_of(args, path)));
  }
  options.base = resolve_chunks(args);
  options.output_of_write = [args](const std::string& path) {
    return resolve_output(args, path, output_format(path, {}));
  };
  if (options.chunks && options.base.surface.isos.size() > 1) {
    refuse("--iso", "chunks are of one surface, but more than one value is given");
  }
  if (options.chunks && options.base.keep) {
    refuse("--keep", "chunks are made one by one, and their components are not known");
  }
  if (options.chunks && options.base.simplify) {
    refuse("--simplify", "chunks are made one by one, and would not fit together");
  }
  if (args.undo) {
    options.undo = static_cast<std::size_t>(
        parse_integer("--undo", *args.undo, 0, std::numeric_limits<std::int32_t>::max()));
  }
  return plan;
}

}  // namespace mc::cli
