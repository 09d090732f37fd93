// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mc/sink.hpp"

// Lists of formats for messages, those of the library before an embedder's.

namespace mc::sink {

/// The names of all formats for which `matches(const SinkFormat&)` is true.
template <class Matches>
std::vector<std::string_view> names_of(SinkFormats further, Matches&& matches) {
  std::vector<std::string_view> names;
  for (const SinkFormats formats : {sink_formats(), further}) {
    for (const SinkFormat* format : formats) {
      if (matches(*format)) names.push_back(format->name);
    }
  }
  return names;
}

/// The names for which `first` is true, then those for which `second` is.
template <class First, class Second>
std::vector<std::string_view> names_of(SinkFormats further, First&& first, Second&& second) {
  std::vector<std::string_view> names = names_of(further, first);
  const std::vector<std::string_view> others = names_of(further, second);
  names.insert(names.end(), others.begin(), others.end());
  return names;
}

/// Names of formats of single pictures; those that hold volumes too come last.
[[nodiscard]] std::vector<std::string_view> picture_names(SinkFormats further);

/// ".a, .b or .c".
[[nodiscard]] std::string dotted(std::span<const std::string_view> names);

/// Names of the library's formats that hold several objects in a file; those in text come last.
[[nodiscard]] std::vector<std::string_view> several_object_names();

/// Throws Error(usage): `format` holds one object in a file; names those that hold several.
[[noreturn]] void refuse_second_object(const SinkFormat& format, std::string_view place);

/// Throws Error(usage): this build has no library for `format`; names the package, and a format
/// that needs none.
[[noreturn]] void refuse_absent(const SinkFormat& format, std::string_view place);

}  // namespace mc::sink
