// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "mc/field.hpp"

// Bits of what is left out, block by block.

namespace mc {
namespace {

TEST(SideMap, KnowsWhatWasLeftOut) {
  SideMap sides;
  EXPECT_TRUE(sides.empty());
  sides.reset({{10, 20, 30}, {10 + 69, 29, 37}}, 4, 3);  // 70 samples: two words, 58 bits over
  sides.leave_out({{13, 24, 33}, {75, 29, 35}}, true);
  sides.leave_out({{76, 28, 33}, {76, 29, 35}}, false);
  EXPECT_EQ(sides.n_left_out(), 63U * 6U * 3U + 2U * 3U);
  constexpr std::uint64_t kPastEnd = ~std::uint64_t{0} << 6;
  EXPECT_EQ(sides.known(23, 33)[0], 0U);
  EXPECT_EQ(sides.known(23, 33)[1], kPastEnd);
  for (const std::int32_t k : {33, 35}) {
    EXPECT_EQ(sides.known(24, k)[0], ~std::uint64_t{7});
    EXPECT_EQ(sides.above(24, k)[0], ~std::uint64_t{7});
    EXPECT_EQ(sides.known(27, k)[1], kPastEnd | 3U);
    EXPECT_EQ(sides.above(27, k)[1], 3U);
    EXPECT_EQ(sides.known(29, k)[1], kPastEnd | 7U);
    EXPECT_EQ(sides.above(29, k)[1], 3U);
  }
  EXPECT_EQ(sides.known(24, 32)[0], 0U);
  EXPECT_EQ(sides.known(24, 36)[0], 0U);
  sides.clear();
  EXPECT_TRUE(sides.empty());
  EXPECT_EQ(sides.n_left_out(), 0U);
}

}  // namespace
}  // namespace mc
