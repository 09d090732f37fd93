// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

// Which SIMD target the kernels run on: the best of this machine unless one is forced.

namespace mc::extraction {

/// Forces a target by Highway's name in lower case, or "scalar". False where this machine or build
/// lacks it. Affects the whole process; call it before the first extraction.
bool set_simd_target(std::string_view name);
/// Goes back to the best target of this machine.
void reset_simd_target();
/// The target in use.
std::string simd_target_name();
/// Every name that set_simd_target() takes here, best first, "scalar" last.
std::vector<std::string> simd_targets();

}  // namespace mc::extraction
