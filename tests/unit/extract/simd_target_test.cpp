// SPDX-License-Identifier: MIT
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdint>

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
#endif

}  // namespace
}  // namespace mc
