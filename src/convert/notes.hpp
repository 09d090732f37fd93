// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

#include "mc/convert.hpp"

// What every conversion notes about its choices.

namespace mc::conversion {

/// Notes which of several grids was taken, unless the caller named one.
void note_chosen_grid(const Source& source, const SourceOptions& options, Progress& progress);
/// Whether meshes of that format can carry the attribute.
[[nodiscard]] bool holds(const SinkFormat& format, const AttributeInfo& attribute);
/// Notes attributes that `format` cannot hold, and which formats can.
void note_left_out(const SinkFormat& format, std::span<const AttributeInfo> attributes,
                   Progress& progress);
/// Warns of vertices at which an attribute's value was clamped; `vertices` says which: "3 of 174
/// vertices".
void warn_of_clamped(std::string_view place, const AttributeInfo& attribute,
                     std::string_view vertices, Progress& progress);
/// Notes each isovalue, and why it is that one.
void note_isos(const Surface& surface, SampleType type, Progress& progress);

}  // namespace mc::conversion
