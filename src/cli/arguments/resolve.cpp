// SPDX-License-Identifier: MIT
#include "cli/arguments/resolve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <unordered_map>

#include "base/machine_memory.hpp"
#include "base/text.hpp"
#include "cli/arguments/command_line.hpp"
#include "cli/arguments/file_list.hpp"
#include "cli/arguments/format_lists.hpp"
#include "cli/arguments/values.hpp"

// Text to plans for the commands that write: defaults filled in, contradictions refused.

namespace mc::cli {

namespace {

/// stdout, or what exists and is no regular file.
bool is_stream(const std::string& output) {
  std::error_code ignored;
  const auto status = std::filesystem::status(output, ignored);
  return output == "-" ||
         (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
          !std::filesystem::is_directory(status));
}

namespace fs = std::filesystem;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

[[noreturn]] void refuse(std::string_view option, std::string_view fault,
                         std::string_view remedy = {}) {
  throw Error(ErrorKind::usage, option, fault, remedy);
}

/// A name for the output beside the first input: "scans/head.raw" to "head".
std::string stem_of(const std::string& input) {
  if (input == "-") return "stdin";
  fs::path path(input);
  if (!path.has_filename()) path = path.parent_path();  // a folder written with a slash at its end
  if (path.extension() == ".gz" || path.extension() == ".zst") path = path.stem();
  std::string stem = path.stem().string();
  std::erase_if(stem, [](char c) { return c == '*' || c == '?' || c == '#'; });
  return stem.empty() || stem == "." || stem == ".." ? "volume" : stem;
}

void check_inputs(std::string_view command, const std::vector<std::string>& inputs) {
  if (inputs.empty()) {
    refuse(command, "no input: expected a file, a folder, or - for stdin",
           fmt::format("see mc {} --help", command));
  }
  for (const std::string& input : inputs) {
    if (input.empty()) refuse(command, "an input's name is empty");
    if (input == "-" && inputs.size() > 1) refuse("-", "stdin must be the only input");
  }
}

[[noreturn]] void refuse_missing_output(std::string_view command, const CommonArgs& common,
                                        const std::vector<std::string>& inputs,
                                        std::string_view extension) {
  refuse(command, "no output: expected -o FILE",
         fmt::format("for example: mc {} {} -o {}", command, shell_text(common.typed),
                     shell_text(std::vector{stem_of(inputs.front()) + std::string(extension)})));
}

void check_output_name(const Text& output) {
  if (output && output->empty()) refuse("--output", "the output's name is empty");
}

IsoChoice parse_iso(std::string_view text) {
  if (text == "otsu") return {IsoChoice::Kind::otsu, 0};
  if (text.starts_with('p')) {
    return {IsoChoice::Kind::percentile, parse_number_within("--iso", text.substr(1), 0, 100)};
  }
  const bool numeric = !text.empty() && std::string_view("+-.0123456789").find(text.front()) !=
                                            std::string_view::npos;
  if (!numeric && text != "nan" && text != "inf") {
    refuse("--iso", fmt::format("unknown value '{}': expected a number, otsu or pNN", text));
  }
  return {IsoChoice::Kind::number, parse_number("--iso", text)};
}

SurfaceChoice resolve_surface(const SurfaceArgs& args, const SinkFormat& format) {
  SurfaceChoice choice;
  if (args.iso) {
    for (const std::string_view part : split(*args.iso, ',')) {
      choice.isos.push_back(parse_iso(part));
    }
  }
  if (choice.isos.size() > 1 && !format.several_objects) {
    refuse(
        "--iso",
        fmt::format("{} values, but {} holds one object a file", choice.isos.size(), format.name),
        fmt::format("choose {}, or extract them one by one",
                    base::enumerate(sink::several_object_names())));
  }
  if (args.inside) {
    static constexpr std::array<std::pair<std::string_view, std::optional<Inside>>, 3> kSides{
        {{"above", Inside::above}, {"below", Inside::below}, {"auto", std::nullopt}}};
    choice.inside = parse_choice("--inside", *args.inside, kSides);
  }
  choice.invert = args.invert;
  if (args.border) {
    static constexpr std::array<std::pair<std::string_view, Border>, 2> kBorders{
        {{"open", Border::open}, {"closed", Border::closed}}};
    choice.border = parse_choice("--border", *args.border, kBorders);
  }
  return choice;
}

/// Region, and where vertices lie on their edges.
ExtractOptions resolve_extraction(const SurfaceArgs& args) {
  ExtractOptions extract;
  if (args.region) extract.region = parse_region("--region", *args.region);
  if (args.topology && *args.topology == "trilinear") {
    refuse("--topology", "trilinear is unknown to this version: expected faces");
  }
  if (args.topology) {
    static constexpr std::array<std::pair<std::string_view, int>, 1> kRules{{{"faces", 0}}};
    parse_choice("--topology", *args.topology, kRules);
  }
  if (args.interpolation) {
    static constexpr std::array<std::pair<std::string_view, Interpolation>, 2> kHow{
        {{"linear", Interpolation::linear}, {"midpoint", Interpolation::midpoint}}};
    extract.interpolation = parse_choice("--interpolation", *args.interpolation, kHow);
  }
  const bool midpoint = extract.interpolation == Interpolation::midpoint;
  if (args.cutoff) extract.cutoff = parse_number_within("--cutoff", *args.cutoff, 0, kInfinity);
  if (args.min_edge) {
    extract.min_edge = parse_number_within("--min-edge", *args.min_edge, 0, 0.5);
  }
  if (midpoint && args.cutoff) refuse("--cutoff", "means nothing with --interpolation midpoint");
  if (midpoint && args.min_edge) {
    refuse("--min-edge", "means nothing with --interpolation midpoint");
  }
  return extract;
}

/// Which components remain.
std::optional<KeepRule> resolve_keep(const SurfaceArgs& args) {
  if (!args.keep) return std::nullopt;
  const std::string_view text = *args.keep;
  if (text == "largest") return KeepRule{};
  static constexpr std::array<std::pair<std::string_view, KeepRule::By>, 2> kSizes{
      {{"volume>=", KeepRule::By::volume}, {"area>=", KeepRule::By::area}}};
  for (const auto& [name, by] : kSizes) {
    if (!text.starts_with(name)) continue;
    return KeepRule{
        .by = by,
        .min_size = parse_number_within("--keep", text.substr(name.size()), 0, kInfinity)};
  }
  if (text.empty() || text.find_first_not_of("+0123456789") != std::string_view::npos) {
    refuse("--keep", fmt::format("unknown value '{}': expected largest, a number, volume>=X or "
                                 "area>=X",
                                 text));
  }
  const std::int64_t n = parse_integer("--keep", text, 1, std::numeric_limits<std::int64_t>::max());
  return KeepRule{.n = static_cast<std::uint64_t>(n)};
}

/// How far to simplify.
std::optional<SimplifyGoal> resolve_simplify(const SurfaceArgs& args) {
  if (!args.simplify) return std::nullopt;
  constexpr std::string_view kOption = "--simplify";
  const std::string_view text = *args.simplify;
  const auto value_of = [&](std::string_view name) -> std::optional<std::string_view> {
    if (!text.starts_with(name)) return std::nullopt;
    return text.substr(name.size());
  };
  if (const auto ratio = value_of("ratio=")) {
    return SimplifyGoal{.by = SimplifyGoal::By::ratio,
                        .ratio = parse_number_within(kOption, *ratio, 0, 1)};
  }
  if (const auto count = value_of("count=")) {
    const std::int64_t n =
        parse_integer(kOption, *count, 0, std::numeric_limits<std::int64_t>::max());
    return SimplifyGoal{.by = SimplifyGoal::By::count, .count = static_cast<std::uint64_t>(n)};
  }
  if (const auto error = value_of("error=")) {
    return SimplifyGoal{.by = SimplifyGoal::By::error,
                        .error = parse_number_within(kOption, *error, 0, kInfinity)};
  }
  refuse(kOption, fmt::format("unknown value '{}': expected ratio=R, count=N or error=E", text));
}

std::optional<Normals> resolve_normals(const SurfaceArgs& args, const SinkFormat& format) {
  if (!args.normals) return std::nullopt;
  const Normals normals = parse_normals(*args.normals);
  if (!format.has_normals && normals != Normals::none) {
    const Names others =
        sink_names([](const SinkFormat& f) { return f.open_mesh != nullptr && f.has_normals; });
    refuse("--normals",
           fmt::format("{} holds no vertex normals, only those of its facets", format.name),
           fmt::format("choose {}", base::enumerate(others)));
  }
  return normals;
}

FrameChoice resolve_frame(const OutputArgs& args) {
  FrameChoice choice;
  if (args.frame) {
    static constexpr std::array<std::pair<std::string_view, std::optional<Frame>>, 3> kFrames{
        {{"source", std::nullopt}, {"ras", Frame::ras}, {"lps", Frame::lps}}};
    choice.frame = parse_choice("--frame", *args.frame, kFrames);
  }
  if (args.up) {
    static constexpr std::array<std::pair<std::string_view, Up>, 2> kAxes{
        {{"y", Up::y}, {"z", Up::z}}};
    choice.up = parse_choice("--up", *args.up, kAxes);
  }
  if (choice.frame && choice.up) {
    refuse("--up", "is for sources without a frame, but --frame gives one");
  }
  if (args.units) {
    static constexpr std::array<std::pair<std::string_view, Units>, 2> kUnits{
        {{"mm", Units::mm}, {"m", Units::m}}};
    choice.units = parse_choice("--units", *args.units, kUnits);
  }
  return choice;
}

SinkOptions resolve_sink(const OutputArgs& args, const SinkFormat& format) {
  if (args.ascii && format.text != TextForm::optional) {
    const Names with = sink_names([](const SinkFormat& f) { return f.text == TextForm::optional; });
    refuse("--ascii", fmt::format("is for {}, not {}", base::enumerate(with, "and"), format.name));
  }
  if (args.precision && !format.precision) {
    const Names with = sink_names([](const SinkFormat& f) { return f.precision; });
    refuse("--precision",
           fmt::format("is for {}, not {}", base::enumerate(with, "and"), format.name));
  }
  SinkOptions sink{
      .to = std::string(format.name), .force = args.force, .sync = args.sync, .ascii = args.ascii};
  if (args.precision) {
    static constexpr std::array<std::pair<std::string_view, Precision>, 2> kHow{
        {{"float", Precision::f32}, {"double", Precision::f64}}};
    sink.precision = parse_choice("--precision", *args.precision, kHow);
  }
  return sink;
}

/// DIR/stem.TO for every input, each name once.
std::vector<Job> batch_jobs(const ExtractArgs& args, const std::vector<std::string>& inputs,
                            const std::string& format) {
  std::vector<Job> jobs;
  jobs.reserve(inputs.size());
  std::unordered_map<std::string, std::string> owner;
  for (const std::string& input : inputs) {
    if (input == "-") refuse("--out-dir", "stdin has no name to call its mesh by", "use -o FILE");
    const std::string output = (fs::path(*args.out_dir) / (stem_of(input) + "." + format)).string();
    const auto [at, fresh] = owner.emplace(output, input);
    if (!fresh) {
      refuse("--out-dir",
             fmt::format("{} and {} would both be written to {}", at->second, input, output),
             "convert them one by one");
    }
    jobs.push_back({{input}, output});
  }
  return jobs;
}

/// What belongs to batches only.
void check_batch(const ExtractArgs& args) {
  for (const auto& [name, given] : {std::pair{"--files-from", args.files_from.has_value()},
                                    {"--skip-existing", args.skip_existing}}) {
    if (given && !args.out_dir) refuse(name, "is for batches: expected --out-dir DIR with it");
  }
  if (args.files_end_in_nul && !args.files_from) {
    refuse("--null", "is for --files-from: expected a FILE of names with it");
  }
  if (args.skip_existing && args.out.force) {
    refuse("--skip-existing", "contradicts --force", "give one of them");
  }
}

void check_report(const ExtractArgs& args, const Job& job) {
  const Text& report = args.out.report;
  if (!report) return;
  if (*report != "-" && std::ranges::find(job.inputs, *report) != job.inputs.end()) {
    refuse("--report", "names the input itself", "give another FILE");
  }
  if (report == job.output && !args.out.dry_run) {
    refuse("--report",
           job.output == "-" ? "cannot go to stdout with --output -" : "names the output itself",
           "give another FILE");
  }
}

void resolve_output(const ExtractArgs& args, const std::vector<std::string>& inputs,
                    ExtractPlan& plan) {
  check_output_name(args.output);
  if (args.output && args.out_dir) refuse("--out-dir", "contradicts --output", "give one of them");
  plan.batch = args.out_dir.has_value();
  plan.out_dir = args.out_dir.value_or("");
  if (plan.batch && plan.out_dir.empty()) refuse("--out-dir", "the folder's name is empty");
  const std::string usual(usual_mesh_format().name);
  if (!plan.batch && !args.output) {
    refuse_missing_output("extract", args.common, inputs, "." + args.out.to.value_or(usual));
  }
  SinkOptions named;
  named.to = args.out.to.value_or(plan.batch ? usual : "");
  const SinkFormat& format = output_format(plan.batch ? "" : *args.output, named);
  plan.format = format.name;
  if (format.open_mesh == nullptr) {
    refuse(
        args.out.to ? "--to" : *args.output,
        fmt::format("{} holds a volume: expected {}", format.name, base::enumerate(mesh_names())),
        "use mc sample to write volumes");
  }
  if (plan.batch) {
    plan.jobs = batch_jobs(args, inputs, plan.format);
  } else {
    plan.jobs = {{inputs, *args.output}};
  }
  for (const Job& job : plan.jobs) {
    check_streamable(job.output, format);
    check_report(args, job);
  }
  if (args.out.report && args.out.report->empty()) {
    refuse("--report", "the report's name is empty");
  }
}

/// "z=0", "k=3".
SliceChoice parse_slice(const std::string& text) {
  static constexpr std::string_view kAxes = "ijkxyz";
  const std::size_t axis =
      text.size() > 2 && text[1] == '=' ? kAxes.find(text[0]) : std::string_view::npos;
  if (axis == std::string_view::npos) {
    refuse("--slice", fmt::format("'{}': expected x, y or z=POSITION, or i, j or k=INDEX", text));
  }
  SliceChoice slice{.axis = static_cast<int>(axis % 3), .world = axis > 2};
  const std::string_view at = std::string_view(text).substr(2);
  slice.at = slice.world ? parse_number("--slice", at)
                         : static_cast<double>(parse_integer(
                               "--slice", at, std::numeric_limits<std::int32_t>::min(),
                               std::numeric_limits<std::int32_t>::max()));
  return slice;
}

/// --slice, and what goes with it only.
std::optional<SliceChoice> resolve_slice(const SampleArgs& args, const SinkFormat& format) {
  for (const auto& [name, given] :
       {std::pair{"--range", args.range.has_value()}, {"--bits", args.bits.has_value()}}) {
    if (given && !format.greys) {
      const Names grey = sink_names([](const SinkFormat& f) { return f.greys; });
      refuse(name, fmt::format("is for {} pictures", find_sink_format(grey.front())->display));
    }
  }
  if (!args.slice) {
    if (format.open_volume == nullptr) {
      refuse("--slice", fmt::format("missing: a {} picture is one slice", format.display),
             "add --slice z=POSITION");
    }
    return std::nullopt;
  }
  if (format.open_picture == nullptr) {
    refuse("--slice",
           fmt::format("{} holds volumes: expected {}", format.name,
                       base::enumerate(sink::picture_names({}))),
           "for a part of a volume use --region");
  }
  SliceChoice slice = parse_slice(*args.slice);
  if (args.bits) {
    static constexpr std::array<std::pair<std::string_view, int>, 2> kBits{{{"8", 8}, {"16", 16}}};
    slice.bits = parse_choice("--bits", *args.bits, kBits);
  }
  if (args.range) {
    const auto parts = split(*args.range, ',');
    if (parts.size() != 2) refuse("--range", fmt::format("'{}': expected LO,HI", *args.range));
    slice.range = {parse_number("--range", parts[0]), parse_number("--range", parts[1])};
    if ((*slice.range)[0] == (*slice.range)[1]) refuse("--range", "black and white are the same");
  }
  return slice;
}

}  // namespace

Normals parse_normals(const std::string& text) {
  static constexpr std::array<std::pair<std::string_view, Normals>, 3> kHow{
      {{"gradient", Normals::gradient}, {"face", Normals::face}, {"none", Normals::none}}};
  return parse_choice("--normals", text, kHow);
}

std::uint64_t resolve_memory(const std::optional<std::string>& text) {
  return text ? parse_size("--memory", *text) : base::default_budget_bytes();
}

ConvertOptions resolve_conversion(const SourceOptions& source, const SurfaceArgs& surface,
                                  const OutputArgs& out, const SinkFormat& format) {
  ConvertOptions options;
  options.source = source;
  options.surface = resolve_surface(surface, format);
  options.extract = resolve_extraction(surface);
  options.normals = resolve_normals(surface, format);
  options.keep = resolve_keep(surface);
  options.simplify = resolve_simplify(surface);
  options.frame = resolve_frame(out);
  options.sink = resolve_sink(out, format);
  options.memory_bytes = resolve_memory(out.memory);
  options.extract.measure = out.report.has_value();
  options.dry_run = out.dry_run;
  options.allow_empty = surface.allow_empty;
  options.skip = !surface.no_skip;
  return options;
}

ConvertOptions resolve_volume(const Text& region, const Text& memory, bool force, bool sync,
                              const SinkFormat& format) {
  ConvertOptions options;
  options.sink = {.to = std::string(format.name), .force = force, .sync = sync};
  if (region) options.extract.region = parse_region("--region", *region);
  options.memory_bytes = resolve_memory(memory);
  return options;
}

void check_streamable(const std::string& output, const SinkFormat& format) {
  if (format.one_file || !is_stream(output)) return;
  refuse(output, fmt::format("{} is two files and cannot be written to a stream", format.display),
         fmt::format("use --to {}", usual_mesh_format().name));
}

ExtractPlan resolve(const ExtractArgs& args) {
  ExtractPlan plan;
  check_batch(args);
  std::vector<std::string> inputs = args.source.inputs;
  if (args.files_from) append_listed(*args.files_from, args.files_end_in_nul, inputs);
  check_inputs("extract", inputs);
  plan.skip_existing = args.skip_existing;
  plan.common = resolve_common(args.common);
  const SourceOptions source = resolve_source(args.source);
  resolve_output(args, inputs, plan);
  plan.convert = resolve_conversion(source, args.surface, args.out, *find_sink_format(plan.format));
  plan.report = args.out.report;
  return plan;
}

SamplePlan resolve(const SampleArgs& args) {
  SamplePlan plan;
  check_inputs("sample", args.source.inputs);
  plan.common = resolve_common(args.common);
  const SourceOptions source = resolve_source(args.source);
  check_output_name(args.output);
  if (!args.output) {
    refuse_missing_output("sample", args.common, args.source.inputs,
                          "." + args.to.value_or(std::string(usual_volume_format().name)));
  }
  SinkOptions named;
  named.to = args.to.value_or("");
  const SinkFormat& format = output_format(*args.output, named);
  if (format.open_mesh != nullptr) {
    refuse(
        args.to ? "--to" : *args.output,
        fmt::format("{} holds a mesh: expected {}", format.name, base::enumerate(volume_names())),
        "use mc extract to write meshes");
  }
  plan.job = {args.source.inputs, *args.output};
  const std::optional<SliceChoice> slice = resolve_slice(args, format);
  plan.convert = resolve_volume(args.region, args.memory, args.force, args.sync, format);
  plan.convert.source = source;
  plan.convert.slice = slice;
  return plan;
}

}  // namespace mc::cli
