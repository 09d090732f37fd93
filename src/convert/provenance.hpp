// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mc/convert.hpp"

namespace mc::conversion {

/// What an output says of the program that made it.
std::pair<std::string, std::string> generator();

/// What is written into a mesh of `format` about how it was made: what was decided, and nothing
/// that differs between two runs with the same choices.
std::vector<std::pair<std::string, std::string>> provenance_of(const Volume& volume,
                                                               const Surface& surface,
                                                               const OutputFrame& frame,
                                                               const SinkFormat& format);

}  // namespace mc::conversion
