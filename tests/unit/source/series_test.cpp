// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <vector>

#include "source/image/series.hpp"

namespace mc::source {
namespace {

std::string gap(const std::vector<std::string>& names) {
  return missing_name(names).value_or("none");
}

TEST(Series, NamesTheFirstGap) {
  EXPECT_EQ(gap({"d/a.0008.exr", "d/a.0009.exr", "d/a.0010.exr", "d/a.0012.exr"}), "d/a.0011.exr");
  EXPECT_EQ(gap({"a1.exr", "a3.exr"}), "a2.exr");
  EXPECT_EQ(gap({"a9.exr", "a10.exr", "a12.exr"}), "a11.exr");
  EXPECT_EQ(gap({"a10.exr", "a20.exr", "a40.exr"}), "a30.exr");
}

TEST(Series, WholeSeriesHaveNone) {
  EXPECT_EQ(gap({"a.exr"}), "none");
  EXPECT_EQ(gap({"a8.exr", "a9.exr", "a10.exr", "a11.exr"}), "none");
  EXPECT_EQ(gap({"a08b2.exr", "a09b2.exr", "a10b2.exr"}), "none");
  EXPECT_EQ(gap({"a10.exr", "a20.exr", "a30.exr"}), "none");  // every tenth
}

TEST(Series, OtherNamesAreNotCounted) {
  EXPECT_EQ(gap({"left.exr", "right.exr", "top.exr"}), "none");
  EXPECT_EQ(gap({"a1b1.exr", "a2b4.exr", "a9b5.exr"}), "none");
  EXPECT_EQ(gap({"a1.exr", "b7.exr"}), "none");
  EXPECT_EQ(gap({"a99999999999999999999.exr", "a99999999999999999999999.exr"}), "none");
}

}  // namespace
}  // namespace mc::source
