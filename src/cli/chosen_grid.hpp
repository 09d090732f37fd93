// SPDX-License-Identifier: MIT
#pragma once

#include "cli/console.hpp"
#include "mc/source.hpp"

namespace mc::cli {

/// Says which of several grids was taken where the user named none.
void note_chosen_grid(const Source& source, const SourceOptions& options, Console& console);

}  // namespace mc::cli
