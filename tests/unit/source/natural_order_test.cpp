// SPDX-License-Identifier: MIT
#include "source/natural_order.hpp"

#include <gtest/gtest.h>

namespace mc::source {
namespace {

TEST(NaturalOrder, CountsDigitsAsNumbers) {
  EXPECT_TRUE(natural_less("slice2", "slice10"));
  EXPECT_FALSE(natural_less("slice10", "slice2"));
  EXPECT_TRUE(natural_less("a2b", "a2c"));
  EXPECT_TRUE(natural_less("a2", "a2b"));
  EXPECT_TRUE(natural_less("v1.9", "v1.10"));
  EXPECT_TRUE(natural_less("99999999999999999999998", "99999999999999999999999"));
}

TEST(NaturalOrder, TellsEqualNumbersApart) {
  EXPECT_NE(natural_less("a1", "a01"), natural_less("a01", "a1"));
  EXPECT_FALSE(natural_less("a1", "a1"));
}

TEST(NaturalOrder, LooksAtFileNamesFirst) {
  EXPECT_TRUE(natural_path_less("z/1", "a/2"));
  EXPECT_TRUE(natural_path_less("a/1", "z/1"));
}

}  // namespace
}  // namespace mc::source
