// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "mc/base.hpp"
#include "source/script/script.hpp"

namespace mc::tests {

/// Reads one script to its end, past its bad records. Returns whether there was none. Anything but
/// Error(usage), or of a file that it names Error(input), comes out.
inline bool replay_script(std::string_view text) {
  bool good = true;
  const auto attempt = [&](auto&& work) {
    try {
      return work();
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::usage) throw;
      good = false;
      return true;
    }
  };
  attempt([&] {
    source::Script script("fuzz.jsonl", std::string(text));
    while (attempt([&] { return script.next().has_value(); })) {
    }
    return true;
  });
  return good;
}

}  // namespace mc::tests
