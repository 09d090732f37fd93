// SPDX-License-Identifier: MIT
#include "convert/notes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "convert/mesh_formats.hpp"

namespace mc::conversion {

void note_chosen_grid(const Source& source, const SourceOptions& options, Progress& progress) {
  if (options.grid || source.other_grids.empty()) return;
  progress.note_remedy(
      fmt::format("{}: grid {} is taken; others: {}", source.place, volume_of(source.reader).name,
                  fmt::join(source.other_grids, ", ")),
      Remedy::choose_grid);
}

bool holds(const SinkFormat& format, const AttributeInfo& attribute) {
  return format.attribute_bytes != nullptr && format.attribute_bytes(attribute, {}) != 0;
}

void note_left_out(const SinkFormat& format, std::span<const AttributeInfo> attributes,
                   Progress& progress) {
  const std::string others = mesh_formats([&](const SinkFormat& other) {
    return std::ranges::all_of(attributes,
                               [&](const AttributeInfo& info) { return holds(other, info); });
  });
  if (attributes.size() == 1 && attributes[0] == material_attribute()) {
    progress.note(
        fmt::format("{} holds no materials, so they are left out; write {}", format.name, others));
    return;
  }
  std::vector<std::string_view> names;
  for (const AttributeInfo& info : attributes) names.push_back(info.name);
  const bool one = attributes.size() == 1;
  progress.note(fmt::format("{} cannot hold the vertex attribute{} {}, so {} left out; write {}",
                            format.name, one ? "" : "s", fmt::join(names, ", "),
                            one ? "it is" : "they are", others));
}

void warn_of_clamped(std::string_view place, const AttributeInfo& attribute,
                     std::string_view vertices, Progress& progress) {
  if (attribute == material_attribute()) {
    progress.warn(fmt::format("{}: {} have a material index outside 0..65535: clamped, NaN to 0",
                              place, vertices));
  } else {
    progress.warn(fmt::format("{}: {} have a value of {} that {} cannot hold: clamped, NaN to 0",
                              place, vertices, attribute.name, sample_name(attribute.type)));
  }
}

void note_isos(const Surface& surface, SampleType type, Progress& progress) {
  for (const Iso& iso : surface.isos) {
    const std::string value = value_text(iso.value, type);
    progress.note(iso.reason.empty() ? fmt::format("iso {}", value)
                                     : fmt::format("iso {} ({})", value, iso.reason));
  }
}

}  // namespace mc::conversion
