// SPDX-License-Identifier: MIT
#include "cli/arguments/format_lists.hpp"

#include <fmt/format.h>

#include "source/formats.hpp"

namespace mc::cli {

Names source_names() { return source::readable_names({}); }

Names mesh_names() {
  return sink_names([](const SinkFormat& f) { return f.open_mesh != nullptr; });
}

Names volume_names() {
  return sink_names([](const SinkFormat& f) { return f.open_mesh == nullptr; });
}

std::string joined(const Names& names) { return fmt::format("{}", fmt::join(names, " ")); }

}  // namespace mc::cli
