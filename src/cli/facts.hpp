// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/placement.hpp"
#include "cli/surface_choice.hpp"
#include "mc/field.hpp"

namespace mc::cli {

/// What is written into a mesh of `format` about how it came to be: what was chosen, and nothing
/// that differs between two runs of one choice.
std::vector<std::pair<std::string, std::string>> facts_of(const Volume& volume,
                                                          std::span<const Iso> isos, Inside inside,
                                                          Border border, const Placement& placement,
                                                          std::string_view format);

}  // namespace mc::cli
