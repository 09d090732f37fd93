// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mc/convert.hpp"

// What `mc edit` says in JSON: a line for each record of the script, one for each output (see
// report.hpp), and one at the end.

namespace mc::cli {

/// How a run of `mc edit` went.
struct EditRunReport {
  int status = 0;
  std::optional<std::string> error;
  ScriptReport done;
  std::uint64_t peak_bytes = 0;  ///< as RunReport's
  std::vector<std::string> warnings;
};

std::string to_json(const RecordReport& report);
std::string to_json(const EditRunReport& report);

}  // namespace mc::cli
