// SPDX-License-Identifier: MIT
#include "cli/format_lists.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.hpp"
#include "source/formats.hpp"

namespace mc::cli {

namespace {

template <class First, class Second>
Names names_in_turn(First&& first, Second&& second) {
  Names names = sink_names(first);
  const Names others = sink_names(second);
  names.insert(names.end(), others.begin(), others.end());
  return names;
}

}  // namespace

Names source_names() { return source::readable_names({}); }

Names mesh_names() {
  return sink_names([](const SinkFormat& f) { return f.open_mesh != nullptr; });
}

Names volume_names() {
  return sink_names([](const SinkFormat& f) { return f.open_mesh == nullptr; });
}

Names picture_names() {
  const auto picture = [](bool volume) {
    return [volume](const SinkFormat& f) {
      return f.open_picture != nullptr && (f.open_volume != nullptr) == volume;
    };
  };
  return names_in_turn(picture(false), picture(true));
}

Names several_object_names() {
  const auto several = [](bool text) {
    return [text](const SinkFormat& f) {
      return f.several_objects && (f.text == TextForm::always) == text;
    };
  };
  return names_in_turn(several(false), several(true));
}

std::string joined(const Names& names) { return fmt::format("{}", fmt::join(names, " ")); }

std::string dotted(const Names& names) {
  std::vector<std::string> extensions;
  for (const std::string_view name : names) extensions.push_back(fmt::format(".{}", name));
  return base::enumerate(Names(extensions.begin(), extensions.end()));
}

const SinkFormat& chunk_format() {
  return **std::ranges::find_if(sink_formats(), [](const SinkFormat* f) { return f->to_memory; });
}

}  // namespace mc::cli
