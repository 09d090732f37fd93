// SPDX-License-Identifier: MIT
#include "cli/arguments/args.hpp"

#include <fmt/format.h>

#include "base/text.hpp"
#include "cli/arguments/format_lists.hpp"

// The option tables. CLI.md's names and meanings are fixed; the manual pages repeat them, and a
// test compares the two.

namespace mc::cli {

namespace {

constexpr std::string_view kProgress = "auto always never json";
constexpr std::string_view kNormals = "gradient face none";

/// Values, and help that lists formats. Options point to it.
struct FormatHelp {
  const std::string from_values = joined(source_names());
  const std::string from =
      fmt::format("what the input is: {} (default: its content)", base::enumerate(source_names()));
  const std::string mesh_values = joined(mesh_names());
  const std::string mesh_to =
      fmt::format("{} (default: by the output's extension)", base::enumerate(mesh_names()));
  const std::string mesh_output =
      fmt::format("{}; - is stdout, with --to", sink::dotted(mesh_names()));
  const std::string volume_values = joined(volume_names());
  const std::string volume_to =
      fmt::format("{} (default: by the output's extension)", base::enumerate(volume_names()));
  const std::string volume_output =
      fmt::format("{}, slices.####{}; with --slice {}", sink::dotted(volumes(false)),
                  sink::dotted(volumes(true)), sink::dotted(sink::picture_names({})));
  const std::string ascii = fmt::format(
      "{}: text form", displays([](const SinkFormat& f) { return f.text == TextForm::optional; }));
  const std::string precision = fmt::format(
      "{}: float or double coordinates", displays([](const SinkFormat& f) { return f.precision; }));

 private:
  /// Formats of volumes that are pictures too, a slice each, or are not.
  static Names volumes(bool pictures) {
    return sink_names([pictures](const SinkFormat& f) {
      return f.open_volume != nullptr && (f.open_picture != nullptr) == pictures;
    });
  }
  template <class Matches>
  static std::string displays(Matches&& matches) {
    Names names = sink_names(matches);
    for (std::string_view& name : names) name = find_sink_format(name)->display;
    return fmt::format("{}", fmt::join(names, ", "));
  }
};

const FormatHelp& format_help() {
  static const FormatHelp help;
  return help;
}

void append(std::vector<Option>& to, std::vector<Option> more) {
  to.insert(to.end(), more.begin(), more.end());
}

std::vector<Option> source_options(SourceArgs& a) {
  return {
      {"--from", "TYPE", format_help().from, false, &a.from, format_help().from_values},
      {"--grid", "NAME", "VDB grid: NAME, NAME[n] or #n (default: the first that is scalar)", true,
       &a.grid},
      {"--channel", "NAME", "pictures: channel to read (default: Y, else R, else the first)", false,
       &a.channel},
      {"--dims", "X,Y[,Z]", "raw data: samples along each axis; without Z the slices are counted",
       true, &a.dims},
      {"--type", "TYPE", "raw data: u8, i8, u16, i16, u32, i32, f16, f32 or f64", true, &a.type,
       "u8 i8 u16 i16 u32 i32 f16 f32 f64"},
      {"--endian", "ORDER", "raw data: little (default) or big", false, &a.endian, "little big"},
      {"--skip", "BYTES", "raw data: header bytes of each file to pass over", false, &a.skip},
      {"--spacing", "X,Y,Z", "world distance between samples; overrides the file's", true,
       &a.spacing},
      {"--origin", "X,Y,Z", "world position of sample 0,0,0; overrides the file's", false,
       &a.origin},
      {"--root", "DIR", "files that specs and headers name must lie in DIR", false, &a.root},
  };
}

std::vector<Option> talk_options(CommonArgs& a) {
  return {
      {"-q,--quiet", "", "no notes and no progress; errors and warnings only", false, &a.quiet},
      {"-v,--verbose", "", "say more; with --help, show every option", false, &a.verbose},
      {"-h,--help", "", "show this text", true, &a.help},
  };
}

Option memory_option(Text& memory) {
  return {"--memory", "SIZE", "most memory to take (default: 1GiB, or a quarter of the machine's)",
          false, &memory};
}

std::vector<Option> run_options(CommonArgs& a, Text& memory) {
  return {
      {"--threads", "N", "threads to use (default: all cores)", false, &a.threads},
      memory_option(memory),
      {"--progress", "WHEN", "auto (default), always, never, or json lines on stderr", false,
       &a.progress, kProgress},
  };
}

std::vector<Option> surface_options(SurfaceArgs& a) {
  return {
      {"--iso", "V[,V...]", "value of the surface: numbers, otsu, or pNN for a percentile", true,
       &a.iso},
      {"--inside", "SIDE", "which side is solid: above, below or auto (default)", true, &a.inside,
       "above below auto"},
      {"--invert", "", "swap the solid side", false, &a.invert},
      {"--region", "I0,J0,K0:I1,J1,K1", "only these samples, both ends inclusive", false,
       &a.region},
      {"--border", "HOW", "open: the mesh ends at the volume's border; closed: it is capped there",
       true, &a.border, "open closed"},
      {"--interpolation", "HOW", "linear (default), or midpoint of each crossed edge", false,
       &a.interpolation, "linear midpoint"},
      {"--cutoff", "D", "edges whose two values differ by less than D take the midpoint", false,
       &a.cutoff},
      {"--min-edge", "E", "keep vertices E of an edge away from its ends (default: 1/1024)", false,
       &a.min_edge},
      {"--topology", "RULE", "faces: one rule for every cell face, always watertight", false,
       &a.topology, "faces"},
      {"--normals", "HOW", "gradient (default where the format holds normals), face or none", false,
       &a.normals, kNormals},
      {"--keep", "WHICH", "components: largest, the N largest, volume>=X or area>=X", true,
       &a.keep},
      {"--simplify", "GOAL", "fewer triangles: ratio=R, count=N, or error=E cells", true,
       &a.simplify},
  };
}

std::vector<Option> frame_options(OutputArgs& a) {
  return {
      {"--frame", "FRAME", "source (default), ras or lps: convert to it, or declare it", false,
       &a.frame, "source ras lps"},
      {"--up", "AXIS", "y (default) or z: up axis of a source that has no frame", false, &a.up,
       "y z"},
      {"--units", "UNIT", "mm or m: convert to it, or declare it", false, &a.units, "mm m"},
  };
}

/// What `extract` and `edit` have in common, in the order of their help.
template <class Args>
void append_surface_options(std::vector<Option>& all, Args& a) {
  append(all, surface_options(a.surface));
  append(all, source_options(a.source));
  append(all, frame_options(a.out));
}
template <class Args>
void append_last_options(std::vector<Option>& all, Args& a) {
  append(all, {{"--allow-empty", "", "a mesh without triangles is a success", false,
                &a.surface.allow_empty},
               {"--no-skip", "", "specs: compute every sample, also far from the surface", false,
                &a.surface.no_skip}});
  append(all, run_options(a.common, a.out.memory));
  append(all, talk_options(a.common));
}

}  // namespace

std::vector<Option> options_of(ExtractArgs& a) {
  std::vector<Option> all{
      {"-o,--output", "FILE", format_help().mesh_output, true, &a.output},
      {"--out-dir", "DIR", "batch: each input becomes a mesh of its own in DIR", true, &a.out_dir},
      {"--to", "TYPE", format_help().mesh_to, true, &a.out.to, format_help().mesh_values},
      {"--files-from", "FILE", "batch: inputs by name, one a line; - is stdin", false,
       &a.files_from},
      {"-0,--null", "", "batch: names of --files-from end in NUL, not in a line's end", false,
       &a.files_end_in_nul},
      {"--skip-existing", "", "batch: leave out inputs whose mesh is there", false,
       &a.skip_existing},
  };
  append_surface_options(all, a);
  append(all,
         {{"--ascii", "", format_help().ascii, false, &a.out.ascii},
          {"--precision", "HOW", format_help().precision, false, &a.out.precision, "float double"},
          {"--report", "FILE", "write what was done as JSON; - is stdout", true, &a.out.report},
          {"--dry-run", "", "say what would be read, chosen and written, and stop", true,
           &a.out.dry_run},
          {"--force", "", "replace an existing output; write binary to a terminal", true,
           &a.out.force},
          {"--sync", "", "be done only when the output is on the disk", false, &a.out.sync}});
  append_last_options(all, a);
  return all;
}

std::vector<Option> options_of(EditArgs& a) {
  std::vector<Option> all{
      {"--script", "FILE", "the edits, of format mc-edits; - is stdin, followed line by line", true,
       &a.script},
      {"-o,--output", "FILE", "a mesh or a volume, by its extension; may be repeated", true,
       &a.outputs},
      {"--to", "TYPE", "a type of mesh or volume, for stdout (default: by the extension)", true,
       &a.out.to},
      {"--emit", "WHAT", "chunks: hand out those parts of the mesh that each record changed", true,
       &a.emit, "chunks"},
      {"--emit-at", "WHEN", "record (default), or write: only at write records and at the end",
       false, &a.emit_at, "record write"},
      {"--chunk-dir", "DIR", "where chunks go, a GLB each (default: to stdout, framed by lines)",
       true, &a.chunk_dir},
      {"--chunk-cells", "N", "cells along a chunk's edge: 8, 16, 32 (default), 64, 128 or 256",
       false, &a.chunk_cells, "8 16 32 64 128 256"},
      {"--journal", "FILE", "record the edits, each with hashes, as a script to replay", true,
       &a.journal},
      {"--sync", "", "be done only when journal and outputs are on the disk", false, &a.out.sync},
      {"--undo", "N", "steps that can be taken back (default: all; live 256)", false, &a.undo},
      {"--keep-going", "", "pass over bad records; the status is 2 all the same", false,
       &a.keep_going},
  };
  append_surface_options(all, a);
  append(all,
         {{"--ascii", "", format_help().ascii, false, &a.out.ascii},
          {"--precision", "HOW", format_help().precision, false, &a.out.precision},
          {"--report", "FILE", "a line of JSON for each record; - is stdout", true, &a.out.report},
          {"--dry-run", "", "say what each edit would touch, and stop", true, &a.out.dry_run},
          {"--force", "", "replace existing outputs; write binary to a terminal", true,
           &a.out.force}});
  append_last_options(all, a);
  return all;
}

std::vector<Option> options_of(SampleArgs& a) {
  std::vector<Option> all{
      {"-o,--output", "FILE", format_help().volume_output, true, &a.output},
      {"--to", "TYPE", format_help().volume_to, true, &a.to, format_help().volume_values},
      {"--region", "I0,J0,K0:I1,J1,K1", "only these samples, both ends inclusive", true, &a.region},
      {"--slice", "AXIS=V", "a picture of one plane: x, y or z=POSITION, or i, j or k=INDEX", true,
       &a.slice},
      {"--range", "LO,HI", "PNG: values of black and white (default: the slice's own)", false,
       &a.range},
      {"--bits", "N", "PNG: 8 or 16 (default)", false, &a.bits, "8 16"},
  };
  append(all, source_options(a.source));
  append(all,
         {{"--force", "", "replace an existing output; write binary to a terminal", true, &a.force},
          {"--sync", "", "be done only when the output is on the disk", false, &a.sync}});
  append(all, run_options(a.common, a.memory));
  append(all, talk_options(a.common));
  return all;
}

std::vector<Option> options_of(InfoArgs& a) {
  std::vector<Option> all{{"--json", "", "one JSON object a line for each input", true, &a.json},
                          {"--memory-estimate", "", "say also what memory a mesh of it takes", true,
                           &a.memory_estimate}};
  append(all, source_options(a.source));
  append(all, run_options(a.common, a.memory));
  append(all, talk_options(a.common));
  return all;
}

std::vector<Option> options_of(CheckArgs& a) {
  std::vector<Option> all{{"--json", "", "one JSON object a line for each mesh", true, &a.json},
                          {"--closed", "", "boundary edges are a defect too", true, &a.closed}};
  append(all, talk_options(a.common));
  return all;
}

std::vector<Option> options_of(BenchArgs& a) {
  std::vector<Option> all{
      {"--json", "", "all figures as one JSON object", true, &a.json},
      {"--noise", "", "noises instead, one thread on every SIMD target", true, &a.noise},
      {"--fields", "LIST", "of sphere, terrain, gyroid and noise (default: all)", true, &a.fields},
      {"--size", "N", "samples along each axis of the fields (default: 256)", true, &a.size},
      {"--type", "TYPE", "u8, i8, u16, i16, u32, i32, f16, f32 (default) or f64", true, &a.type,
       "u8 i8 u16 i16 u32 i32 f16 f32 f64"},
      {"--normals", "HOW", "none (default), gradient or face", true, &a.normals, kNormals},
      {"--threads", "N[,N...]", "numbers of threads to use (default: one, and all cores)", true,
       &a.threads},
      {"--seconds", "S", "go on for so long with each table's line (default: 1)", true, &a.seconds},
  };
  append(all, talk_options(a.common));
  return all;
}

std::vector<Option> options_of(CompletionArgs& a) { return talk_options(a.common); }

std::vector<Option> options_of(TopArgs& a) {
  std::vector<Option> all{
      {"--version", "", "show the version; with -v, what was built in", true, &a.version}};
  append(all, talk_options(a.common));
  return all;
}

}  // namespace mc::cli
