// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

// The order in which people number files: runs of digits count as numbers, so that 2 is before 10.

namespace mc::source {

/// Whether `a` comes before `b`. Runs of digits compare by value, of any length; all else by byte.
/// Names that are equal in that sense (a1, a01) fall back to bytes: a strict weak order in which
/// only equal names are equivalent.
[[nodiscard]] bool natural_less(std::string_view a, std::string_view b);

/// natural_less of the file names (what follows the last slash), then of the whole paths.
[[nodiscard]] bool natural_path_less(std::string_view a, std::string_view b);

}  // namespace mc::source
