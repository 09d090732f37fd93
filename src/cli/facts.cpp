// SPDX-License-Identifier: MIT
#include "cli/facts.hpp"

#include <fmt/format.h>

namespace mc::cli {

std::vector<std::pair<std::string, std::string>> facts_of(const Volume& volume,
                                                          std::span<const Iso> isos, Inside inside,
                                                          Border border, const Placement& placement,
                                                          std::string_view format) {
  std::vector<std::pair<std::string, std::string>> facts{{"generator", "mc " MC_VERSION}};
  if (!volume.name.empty()) facts.emplace_back("grid", volume.name);
  std::vector<std::string> values;
  for (const Iso& iso : isos) values.push_back(iso_text(iso.value, volume.type));
  facts.emplace_back("iso", fmt::format("{}", fmt::join(values, ",")));
  facts.emplace_back("inside", name_of(inside));
  facts.emplace_back("border", name_of(border));
  const bool y_up = find_sink_format(format)->y_up_metres;
  facts.emplace_back("frame", name_of(y_up ? placement.source_frame : placement.frame));
  if (y_up || placement.source_frame == Frame::none) {
    facts.emplace_back("up", y_up ? "y" : name_of(placement.source_up));
  }
  facts.emplace_back("units", name_of(placement.units));
  return facts;
}

}  // namespace mc::cli
