// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>

namespace mc::source {

/// Of names in natural order that differ in one number only, the first that is missing: numbers go
/// up in steps of 1, or three files and more in equal steps (a choice of every n-th slice).
/// nullopt: none is, or the names are not numbered so.
[[nodiscard]] std::optional<std::string> missing_name(std::span<const std::string> paths);

}  // namespace mc::source
