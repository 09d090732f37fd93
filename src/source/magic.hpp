// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string_view>

#include "mc/source.hpp"

namespace mc::source {

/// Whether the bytes from `at` on are `magic`.
[[nodiscard]] constexpr bool has_magic(std::string_view head, std::string_view magic,
                                       std::size_t at = 0) {
  return head.size() >= at && head.substr(at, magic.size()) == magic;
}

/// The answer of a format that is never unsure.
[[nodiscard]] constexpr Recognition recognised(bool yes) {
  return yes ? Recognition::yes : Recognition::no;
}

}  // namespace mc::source
