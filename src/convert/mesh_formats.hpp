// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "base/text.hpp"
#include "sink/formats.hpp"

namespace mc::conversion {

/// The mesh formats for which `matches(const SinkFormat&)` is true, as a remedy lists them: "a, b
/// or c".
template <class Matches>
std::string mesh_formats(Matches&& matches) {
  return base::enumerate(sink::names_of(
      {}, [&](const SinkFormat& f) { return f.open_mesh != nullptr && matches(f); }));
}

}  // namespace mc::conversion
