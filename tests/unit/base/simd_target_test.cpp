// SPDX-License-Identifier: MIT
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/simd_target.hpp"

#define HWY_WANT_AVX3_DL 1
#include "hwy/targets.h"

namespace mc {
namespace {

// What Highway's own library says, which mc does not link.
#if HWY_ARCH_X86
TEST(SimdTarget, AreThoseThatHighwayFinds) {
  void* library = ::dlopen("libhwy.so.1", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) GTEST_SKIP() << "Highway's library is not installed";
  const auto theirs =
      reinterpret_cast<std::int64_t (*)()>(::dlsym(library, "_ZN3hwy16SupportedTargetsEv"));
  ASSERT_NE(theirs, nullptr);
  constexpr std::int64_t kAll = HWY_SSSE3 | HWY_SSE4 | HWY_AVX2 | HWY_AVX3 | HWY_AVX3_DL;
  EXPECT_EQ(hwy::SupportedTargets() & kAll, theirs() & kAll);
}

TEST(SimdTarget, ThisMachineOffersX86TargetsOnly) {
  for (const std::string& name : base::simd_targets()) {
    EXPECT_FALSE(name.starts_with("sve") || name == "neon") << name;
  }
  EXPECT_FALSE(base::set_simd_target("neon"));
}
#endif

TEST(SimdTarget, NamesAndBitsAreUnique) {
  std::set<std::string_view> names;
  std::int64_t seen = 0;
  for (const base::SimdTarget& target : base::known_simd_targets()) {
    EXPECT_TRUE(names.insert(target.name).second) << target.name;
    EXPECT_EQ(seen & target.bits, 0) << target.name;
    seen |= target.bits;
  }
}

TEST(SimdTarget, AreNamedAsHighwayNamesThem) {
  const auto names = [](std::int64_t bits) { return base::names_of_targets(bits); };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(HWY_SSSE3 | HWY_SSE4 | HWY_AVX2 | HWY_AVX3 | HWY_AVX3_DL | HWY_EMU128),
            (Names{"avx3_dl", "avx3", "avx2", "sse4", "ssse3", "scalar"}));
  EXPECT_EQ(names(HWY_NEON | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128),
            (Names{"sve2_128", "sve_256", "sve2", "sve", "neon"}));
  EXPECT_EQ(names(HWY_NEON), Names{"neon"});
  EXPECT_EQ(names(HWY_SCALAR), Names{"scalar"});
}

TEST(SimdTarget, BetterTargetsComeFirst) {
  const auto targets = base::known_simd_targets();
  for (std::size_t n = 1; n < targets.size(); ++n) {
    EXPECT_LT(std::countr_zero(static_cast<std::uint64_t>(targets[n - 1].bits)),
              std::countr_zero(static_cast<std::uint64_t>(targets[n].bits)));
  }
}

}  // namespace
}  // namespace mc
