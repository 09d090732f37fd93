// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "mc/convert.hpp"

// Which surface: the iso value, the solid side and the border, from what was asked for, what the
// volume says of itself, and, only where it must be, what the data are.

namespace mc::conversion {

/// Statistics with the given percentiles, in their order; called at most once.
using Measure = std::function<FieldStatistics(std::span<const double> percentiles)>;

/// `further` are the formats beside the library's own, one of which may be the volume's.
/// Errors   empty: the data hold no finite number, and the iso depends on them; usage: an iso that
///          is not finite in the volume's type.
std::vector<Iso> choose_isos(std::span<const IsoChoice> asked, const Volume& volume,
                             std::string_view place, const Measure& measure,
                             SourceFormats further = {});
/// Whether choose_isos() will have to read the data.
bool iso_needs_data(std::span<const IsoChoice> asked, const Volume& volume);

Inside choose_inside(const SurfaceChoice& choice, const Volume& volume);
Border choose_border(const SurfaceChoice& choice, const Volume& volume);

}  // namespace mc::conversion
