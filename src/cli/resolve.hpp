// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/args.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"
#include "mc/sink.hpp"
#include "mc/source.hpp"

// From text to typed and complete options: the second shape. Everything that the command line alone
// can get wrong is found here, before any file is opened, and nothing is clamped.

namespace mc::cli {

enum class ProgressMode : std::uint8_t { automatic, always, never, json };
enum class Up : std::uint8_t { y, z };

/// How a command talks, and how many threads it has.
struct CommonOptions {
  ProgressMode progress = ProgressMode::automatic;
  int threads = 0;  ///< 0: all cores
  bool quiet = false;
  bool verbose = false;
};

/// A surface value as asked for; which number it is may depend on the data.
struct IsoChoice {
  enum class Kind : std::uint8_t { number, otsu, percentile };
  Kind kind = Kind::number;
  double value = 0;  ///< the number, or the percentile in [0, 100]
};

/// Where the mesh should lie; unset: as the source says (DESIGN section 5).
struct PlaceChoice {
  std::optional<Frame> frame{};  ///< ras or lps
  std::optional<Up> up{};
  std::optional<Units> units{};  ///< mm or m
};

/// One volume that becomes one mesh.
struct Job {
  std::vector<std::string> inputs;  ///< one, or the slices of one volume
  std::string output;               ///< "-" is stdout
};

struct ExtractPlan {
  std::vector<Job> jobs;  ///< one, but in a batch
  bool batch = false;
  bool skip_existing = false;  ///< batch: leave out jobs whose output is there
  SourceOptions source;
  SinkOptions sink;
  std::string format;           ///< of the output: SinkFormat::name
  std::vector<IsoChoice> isos;  ///< empty: decided by the volume
  std::optional<Inside> inside;
  bool invert = false;
  std::optional<Border> border;
  ExtractOptions extract;  ///< all but iso, inside, border, precision and origin
  PlaceChoice place;
  std::uint64_t memory_bytes = 1ULL << 30;
  std::optional<std::string> report;
  bool dry_run = false;
  bool allow_empty = false;
  bool skip = true;
  bool tells_iso = true;  ///< notes say which iso was taken, and why
  CommonOptions common;
};

/// Which plane of samples becomes a picture, and which greys its values are.
struct SliceChoice {
  int axis = 2;        ///< 0, 1, 2
  bool world = false;  ///< `at` is a world coordinate, else an index
  double at = 0;
  int bits = 16;                                 ///< PNG: 8 or 16
  std::optional<std::array<double, 2>> range{};  ///< PNG: black and white; unset: least, greatest
};

struct SamplePlan {
  Job job;
  SourceOptions source;
  SinkOptions sink;
  std::string format;
  std::optional<IndexBox> region;
  std::optional<SliceChoice> slice;
  std::uint64_t memory_bytes = 1ULL << 30;
  CommonOptions common;
};

/// All Errors of these are of kind usage.
CommonOptions resolve_common(const CommonArgs& args);
SourceOptions resolve_source(const SourceArgs& args);
/// The budget of --memory, or the default.
std::uint64_t resolve_memory(const std::optional<std::string>& text);
/// The values of --type and --normals.
SampleType parse_type(const std::string& text);
Normals parse_normals(const std::string& text);
/// Reads the names of --files-from. Errors   input: what holds them cannot be read.
ExtractPlan resolve(const ExtractArgs& args);
SamplePlan resolve(const SampleArgs& args);

}  // namespace mc::cli
