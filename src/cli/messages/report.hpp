// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mc/convert.hpp"

// What the program says in JSON: `--report`, `info --json`, `check --json`. Each is one line. Keys
// are CLI.md's; what is unknown is null.

namespace mc::cli {

/// How an extraction went, filled in as far as it came.
struct RunReport {
  int status = 0;
  bool skipped = false;  ///< by --skip-existing
  std::optional<std::string> error;
  std::optional<std::string> output;
  ConvertReport done;
  std::uint64_t peak_bytes = 0;  ///< maximum that the process held, pages of mapped files aside
  std::vector<std::string> warnings;
};

std::string to_json(const RunReport& report);

/// A grid as `info` sees it.
struct GridInfo {
  GridDescription description;
  std::optional<FieldStatistics> statistics;  ///< of grids that can be meshed
  double iso = 0;                             ///< suggested; only with statistics
  std::string iso_reason;
  std::optional<MemoryNeed> memory;  ///< of an extraction, where that was asked for
};

/// The percentiles that `info` shows.
inline constexpr double kInfoPercentiles[] = {1, 5, 25, 50, 75, 95, 99};

struct InputInfo {
  std::string place;
  std::vector<GridInfo> grids;
  std::optional<std::string> error;
};

std::string to_json(const InputInfo& info);
std::string to_json(const std::string& path, const MeshReport& report, bool defective);

const char* name_of(VolumeClass cls);

/// "40.0 MiB expected, 512.0 MiB at most, of 1.0 GiB; 13.0 MiB would do".
std::string memory_text(const MemoryNeed& need);

/// What --dry-run prints.
std::string dry_run_text(const ConvertReport& report, const std::string& output,
                         const std::optional<IndexBox>& region);

}  // namespace mc::cli
