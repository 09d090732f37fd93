// SPDX-License-Identifier: MIT
#define HWY_WANT_AVX3_DL 1
#include "hwy/targets.h"

#include <algorithm>
#include <array>

#include "base/simd_target.hpp"

// The process's choice of a SIMD target, which Highway makes and does not report.

namespace mc::base {

namespace {

constexpr std::int64_t kPlain = HWY_EMU128 | HWY_SCALAR;

// Highway gives better targets of one architecture lower bits.
constexpr std::array<SimdTarget, 11> kTargets{{{"avx3_dl", HWY_AVX3_DL},
                                               {"avx3", HWY_AVX3},
                                               {"avx2", HWY_AVX2},
                                               {"sse4", HWY_SSE4},
                                               {"ssse3", HWY_SSSE3},
                                               {"sve2_128", HWY_SVE2_128},
                                               {"sve_256", HWY_SVE_256},
                                               {"sve2", HWY_SVE2},
                                               {"sve", HWY_SVE},
                                               {"neon", HWY_NEON},
                                               {"scalar", kPlain}}};

std::int64_t offered() { return hwy::SupportedTargets() & HWY_TARGETS; }

std::string_view forced;

}  // namespace

std::span<const SimdTarget> known_simd_targets() { return kTargets; }

std::vector<std::string> names_of_targets(std::int64_t bits) {
  std::vector<std::string> names;
  for (const SimdTarget& target : kTargets) {
    if ((target.bits & bits) != 0) names.emplace_back(target.name);
  }
  return names;
}

bool set_simd_target(std::string_view name) {
  const auto* const found = std::ranges::find(kTargets, name, &SimdTarget::name);
  if (found == kTargets.end() || (found->bits & offered()) == 0) return false;
  // An empty set leaves the baseline, which has no vectors where "scalar" is offered.
  hwy::GetChosenTarget().Update(found->bits & ~kPlain);
  forced = found->name;
  return true;
}

void reset_simd_target() {
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  forced = {};
}

std::string simd_target_name() {
  return forced.empty() ? simd_targets().front() : std::string(forced);
}

std::vector<std::string> simd_targets() { return names_of_targets(offered()); }

}  // namespace mc::base
