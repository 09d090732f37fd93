// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments/args.hpp"
#include "mc/convert.hpp"

// From text to typed and complete options: the second shape. Everything that the command line alone
// can get wrong is found here, before any file is opened, and nothing is clamped.

namespace mc::cli {

enum class ProgressMode : std::uint8_t { automatic, always, never, json };

/// How a command talks, and how many threads it has.
struct CommonOptions {
  ProgressMode progress = ProgressMode::automatic;
  int threads = 0;  ///< 0: all cores
  bool quiet = false;
  bool verbose = false;
};

/// One volume that becomes one mesh or volume.
struct Job {
  std::vector<std::string> inputs;  ///< one, or the slices of one volume
  std::string output;               ///< "-" is stdout
};

struct ExtractPlan {
  std::vector<Job> jobs;  ///< one, but in a batch
  bool batch = false;
  std::string out_dir;         ///< of a batch
  bool skip_existing = false;  ///< batch: leave out jobs whose output exists
  std::string format;          ///< of the output: SinkFormat::name
  ConvertOptions convert;
  std::optional<std::string> report;
  CommonOptions common;
};

struct SamplePlan {
  Job job;
  ConvertOptions convert;
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
/// How a volume becomes a mesh of `format`.
ConvertOptions resolve_conversion(const SourceOptions& source, const SurfaceArgs& surface,
                                  const OutputArgs& out, const SinkFormat& format);
/// How samples are written as a volume of `format`.
ConvertOptions resolve_volume(const Text& region, const Text& memory, bool force, bool sync,
                              const SinkFormat& format);
/// Refuses glTF to a stream.
void check_streamable(const std::string& output, const SinkFormat& format);
/// Reads the names of --files-from. Errors   input: what holds them cannot be read.
ExtractPlan resolve(const ExtractArgs& args);
SamplePlan resolve(const SampleArgs& args);

}  // namespace mc::cli
