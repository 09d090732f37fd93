// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cli/resolve.hpp"

// Typed options of `mc edit`.

namespace mc::cli {

/// A file that the edited volume is written to, as a mesh or as a volume.
struct EditOutput {
  std::string path;
  std::variant<ExtractPlan, SamplePlan> plan;
};

struct EditPlan {
  ExtractPlan surface;  ///< input, iso, side and border, and how chunks are meshed
  std::vector<EditOutput> outputs;
  std::string script;                    ///< "-" is stdin
  bool emits = false;                    ///< chunks: first all, then those that changed
  bool emits_at_writes = false;          ///< not after each record, but writes, and at the end
  std::optional<std::string> chunk_dir;  ///< where they go; unset: stdout
  std::int32_t chunk_cells = 32;
  std::optional<std::string> journal;
  std::optional<std::string> report;  ///< "-" is stdout
  std::optional<std::size_t> undo;    ///< steps to keep
  bool keep_going = false;
  bool dry_run = false;

  /// Chunks go to stdout, between the lines that tell of them.
  [[nodiscard]] bool sends_chunks() const { return emits && !chunk_dir; }
  [[nodiscard]] bool lines_on_stdout() const {
    return report == "-" || sends_chunks() || (emits && !report);
  }
};

/// Errors   usage.
EditPlan resolve(const EditArgs& args);
/// The output that a script's write record asks for, with the command line's options.
EditOutput resolve_write(const EditArgs& args, const std::string& path);

}  // namespace mc::cli
