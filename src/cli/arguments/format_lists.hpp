// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mc/sink.hpp"
#include "mc/source.hpp"
#include "sink/formats.hpp"

// Formats as help, messages and completions list them: always from their rows.

namespace mc::cli {

using Names = std::vector<std::string_view>;

/// Formats that can be read.
Names source_names();

/// Formats that can be written and for which `matches(const SinkFormat&)` is true.
template <class Matches>
Names sink_names(Matches&& matches) {
  return sink::names_of({}, matches);
}
Names mesh_names();
/// Formats of volumes and pictures.
Names volume_names();

/// "a b c".
std::string joined(const Names& names);

}  // namespace mc::cli
