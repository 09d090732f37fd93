// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "mc/convert.hpp"

// What every conversion notes about its choices.

namespace mc::conversion {

/// Notes which of several grids was taken, unless the caller named one.
void note_chosen_grid(const Source& source, const SourceOptions& options, Progress& progress);
/// Warns of vertices whose material index was clamped; `vertices` says which: "3 of 174 vertices".
void warn_of_clamped_materials(std::string_view place, std::string_view vertices,
                               Progress& progress);
/// Notes each isovalue, and why it is that one.
void note_isos(const Surface& surface, SampleType type, Progress& progress);

}  // namespace mc::conversion
