// SPDX-License-Identifier: MIT
#include "convert/notes.hpp"

#include <fmt/format.h>

namespace mc::conversion {

void note_chosen_grid(const Source& source, const SourceOptions& options, Progress& progress) {
  if (options.grid || source.other_grids.empty()) return;
  progress.note_remedy(
      fmt::format("{}: grid {} is taken; others: {}", source.place, volume_of(source.reader).name,
                  fmt::join(source.other_grids, ", ")),
      Remedy::choose_grid);
}

void warn_of_clamped_materials(std::string_view place, std::string_view vertices,
                               Progress& progress) {
  progress.warn(fmt::format("{}: {} have a material index outside 0..65535: clamped, NaN to 0",
                            place, vertices));
}

void note_isos(const Surface& surface, SampleType type, Progress& progress) {
  for (const Iso& iso : surface.isos) {
    const std::string value = value_text(iso.value, type);
    progress.note(iso.reason.empty() ? fmt::format("iso {}", value)
                                     : fmt::format("iso {} ({})", value, iso.reason));
  }
}

}  // namespace mc::conversion
