// SPDX-License-Identifier: MIT
#include "cli/chosen_grid.hpp"

#include <fmt/format.h>

namespace mc::cli {

void note_chosen_grid(const Source& source, const SourceOptions& options, Console& console) {
  if (options.grid || source.other_grids.empty()) return;
  console.note(fmt::format("{}: grid {} is taken; others: {}; choose with --grid", source.place,
                           volume_of(source.reader).name, fmt::join(source.other_grids, ", ")));
}

}  // namespace mc::cli
