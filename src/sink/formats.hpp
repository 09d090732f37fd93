// SPDX-License-Identifier: MIT
#pragma once

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

/// Throws Error(usage): this build has no library for `format`; names the package, and a format
/// that needs none.
[[noreturn]] void refuse_absent(const SinkFormat& format, std::string_view place);

}  // namespace mc::sink
