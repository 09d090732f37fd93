// SPDX-License-Identifier: MIT
#include "convert/provenance.hpp"

#include <fmt/format.h>

namespace mc::conversion {

std::pair<std::string, std::string> generator() {
  return {"generator", fmt::format("mc {}", version())};
}

std::vector<std::pair<std::string, std::string>> provenance_of(const Volume& volume,
                                                               const Surface& surface,
                                                               const OutputFrame& frame,
                                                               const SinkFormat& format) {
  std::vector<std::pair<std::string, std::string>> facts{generator()};
  if (!volume.name.empty()) facts.emplace_back("grid", volume.name);
  std::vector<std::string> values;
  for (const Iso& iso : surface.isos) values.push_back(value_text(iso.value, volume.type));
  facts.emplace_back("iso", fmt::format("{}", fmt::join(values, ",")));
  facts.emplace_back("inside", name_of(surface.inside));
  facts.emplace_back("border", name_of(surface.border));
  const bool y_up = format.y_up_metres;
  facts.emplace_back("frame", name_of(y_up ? frame.source_frame : frame.frame));
  if (y_up || frame.source_frame == Frame::none) {
    facts.emplace_back("up", y_up ? "y" : name_of(frame.source_up));
  }
  facts.emplace_back("units", name_of(frame.units));
  return facts;
}

}  // namespace mc::conversion

namespace mc {

std::string_view version() { return MC_VERSION; }

}  // namespace mc
