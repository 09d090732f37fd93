// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/arguments/resolve.hpp"

// Typed options of `mc edit`.

namespace mc::cli {

struct EditPlan {
  std::vector<std::string> inputs;
  std::string script;  ///< "-" is stdin
  ScriptOptions options;
  std::optional<std::string> report;  ///< "-" is stdout
  CommonOptions common;

  /// Chunks go to stdout, between the lines of JSON about them.
  [[nodiscard]] bool sends_chunks() const { return options.chunks && !options.chunks->folder; }
  [[nodiscard]] bool lines_on_stdout() const {
    return report == "-" || sends_chunks() || (options.chunks && !report);
  }
};

/// Errors   usage.
EditPlan resolve(const EditArgs& args);

}  // namespace mc::cli
