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
  ExtractPlan surface;  ///< input, iso, side and border
  std::vector<EditOutput> outputs;
  std::string script;  ///< "-" is stdin
  std::optional<std::string> journal;
  std::optional<std::string> report;  ///< "-" is stdout
  std::optional<std::size_t> undo;    ///< steps to keep
  bool keep_going = false;
  bool dry_run = false;
};

/// Errors   usage.
EditPlan resolve(const EditArgs& args);
/// The output that a script's write record asks for, with the command line's options.
EditOutput resolve_write(const EditArgs& args, const std::string& path);

}  // namespace mc::cli
