// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Which SIMD target the kernels run on: the best of this machine unless one is forced.

namespace mc::base {

/// A target's name and its bits in Highway's sets of targets.
struct SimdTarget {
  std::string_view name;
  std::int64_t bits;
};

/// The targets of all architectures by Highway's names in lower case, best first; last "scalar",
/// which stands for Highway's targets without vectors.
std::span<const SimdTarget> known_simd_targets();
/// The names of a set of Highway's targets, best first.
std::vector<std::string> names_of_targets(std::int64_t bits);

/// Forces a target by its name. Returns false if this machine or build lacks it. Affects the whole
/// process; call it before the first extraction.
bool set_simd_target(std::string_view name);
/// Goes back to the best target of this machine.
void reset_simd_target();
/// The target in use.
std::string simd_target_name();
/// Every name that set_simd_target() accepts here, best first.
std::vector<std::string> simd_targets();

}  // namespace mc::base
