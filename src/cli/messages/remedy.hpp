// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "mc/base.hpp"

namespace mc::cli {

/// What the library says, with the option that changes it.
std::string with_remedy(std::string_view text, Remedy remedy);

}  // namespace mc::cli
