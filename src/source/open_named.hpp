// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "mc/source.hpp"
#include "source/spec/spec_files.hpp"

namespace mc::source {

/// Opens a volume that a document names: what open_source() opens without options. A document is
/// opened within `within`.
/// Errors   those of open_source(); input: what does not say its own type and sizes, a device or
///          FIFO, a grid of what has none.
Source open_named(const std::string& path, const std::optional<std::string>& grid,
                  const SpecNesting& within);

}  // namespace mc::source
