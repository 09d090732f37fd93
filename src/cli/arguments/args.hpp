// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

// What the user typed, as text: the first of the three shapes that options pass through (text,
// typed options, what the engine takes). Every option that takes a value is one string, so that
// `--iso -300.5` and lists with commas arrive whole; resolve.hpp reads them.

namespace mc::cli {

using Text = std::optional<std::string>;
using Texts = std::vector<std::string>;  ///< of an option that may be repeated

/// How a source is to be read; the same for every command that takes volumes.
struct SourceArgs {
  std::vector<std::string> inputs;
  Text from, grid, channel, dims, type, endian, skip, spacing, origin, root;
};

/// Options of every command.
struct CommonArgs {
  Text progress, threads;
  int quiet = 0, verbose = 0;
  bool help = false;
  std::vector<std::string> typed;  ///< the command's words as they were typed, for messages
};

/// Which surface is made, and how.
struct SurfaceArgs {
  Text iso, inside, region, border;
  bool invert = false;
  Text interpolation, cutoff, min_edge, topology, normals, keep, simplify;
  bool allow_empty = false, no_skip = false;
};

/// How meshes and volumes are written, whichever they are.
struct OutputArgs {
  Text to;
  Text frame, up, units;
  bool ascii = false;
  Text precision;
  Text memory, report;
  bool dry_run = false, force = false, sync = false;
};

struct ExtractArgs {
  SourceArgs source;
  CommonArgs common;
  SurfaceArgs surface;
  OutputArgs out;
  Text output, out_dir, files_from;
  bool files_end_in_nul = false, skip_existing = false;
};

struct EditArgs {
  SourceArgs source;
  CommonArgs common;
  SurfaceArgs surface;
  OutputArgs out;
  Texts outputs;
  Text script, emit, emit_at, chunk_dir, chunk_cells, journal, undo;
  bool keep_going = false;
};

struct SampleArgs {
  SourceArgs source;
  CommonArgs common;
  Text output, to, region, slice, range, bits, memory;
  bool force = false, sync = false;
};

struct InfoArgs {
  SourceArgs source;
  CommonArgs common;
  Text memory;
  bool json = false, memory_estimate = false;
};

struct CheckArgs {
  std::vector<std::string> inputs;
  CommonArgs common;
  bool json = false, closed = false;
};

struct BenchArgs {
  CommonArgs common;
  Text fields, size, type, normals, threads, seconds;
  bool json = false, noise = false;
};

struct CompletionArgs {
  CommonArgs common;
};

/// Options before any command.
struct TopArgs {
  CommonArgs common;
  bool version = false;
};

/// One option: how it is shown, and where its text goes.
struct Option {
  std::string_view names;  ///< "--iso", or "-o,--output"
  std::string_view value;  ///< placeholder in help; empty for a flag
  std::string_view help;
  bool basic = false;  ///< shown by --help without -v
  std::variant<Text*, Texts*, bool*, int*> target;
  std::string_view values = {};  ///< all that it can be, with blanks between; empty: anything
};

/// The options of a command, bound to `args`, in the order help shows them. The one table that
/// parsing, help, and the test of the manual pages read.
std::vector<Option> options_of(ExtractArgs& args);
std::vector<Option> options_of(EditArgs& args);
std::vector<Option> options_of(SampleArgs& args);
std::vector<Option> options_of(InfoArgs& args);
std::vector<Option> options_of(CheckArgs& args);
std::vector<Option> options_of(BenchArgs& args);
std::vector<Option> options_of(CompletionArgs& args);
std::vector<Option> options_of(TopArgs& args);

}  // namespace mc::cli
