// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cli/resolve.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"

// Which surface: the iso value, the solid side and the border, from what was asked for, what the
// volume says of itself, and, only where it must be, what the data are.

namespace mc::cli {

struct Iso {
  double value = 0;    ///< as used and printed: rounded to float for f16 and f32 data
  std::string reason;  ///< "fog volume", "otsu", "p50"; empty where the user gave the number
};

/// Statistics with the given percentiles, in their order; called at most once.
using Measure = std::function<FieldStatistics(std::span<const double> percentiles)>;

/// Errors   empty: the data hold no finite number, and the iso depends on them.
std::vector<Iso> choose_isos(std::span<const IsoChoice> asked, const Volume& volume,
                             std::string_view place, const Measure& measure);
/// Whether choose_isos() will have to read the data.
bool iso_needs_data(std::span<const IsoChoice> asked, const Volume& volume);

/// The iso that a volume without --iso gets; `statistics` may be null where iso_needs_data() is
/// false.
Iso default_iso(const Volume& volume, const FieldStatistics* statistics);

Inside choose_inside(std::optional<Inside> asked, bool invert, const Volume& volume);
Border choose_border(std::optional<Border> asked, const Volume& volume);

/// The shortest text that reads back as this value of this type.
std::string iso_text(double value, SampleType type);

const char* name_of(Inside inside);
const char* name_of(Border border);

}  // namespace mc::cli
