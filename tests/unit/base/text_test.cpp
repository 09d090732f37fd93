// SPDX-License-Identifier: MIT
#include "base/text.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace mc::base {
namespace {

TEST(Text, ExtensionsAreInLowerCase) {
  EXPECT_EQ(extension_of("a/b.c/d.PLY"), "ply");
  EXPECT_EQ(extension_of("a.tar.gz"), "gz");
  EXPECT_EQ(extension_of("a.b/mesh"), "");
  EXPECT_EQ(extension_of("mesh."), "");
  EXPECT_EQ(extension_of(""), "");
}

TEST(Text, FindsWholeWords) {
  EXPECT_TRUE(has_word("mhd mha", "mhd"));
  EXPECT_TRUE(has_word("mhd mha", "mha"));
  EXPECT_FALSE(has_word("mhd mha", "mh"));
  EXPECT_FALSE(has_word("mhd mha", ""));
  EXPECT_FALSE(has_word("mhd mha", "mhd mha"));
  EXPECT_FALSE(has_word("", "mhd"));
}

TEST(Text, EnumeratesNames) {
  using Names = std::vector<std::string_view>;
  EXPECT_EQ(enumerate(Names{}), "");
  EXPECT_EQ(enumerate(Names{"a"}), "a");
  EXPECT_EQ(enumerate(Names{"a", "b"}, "and"), "a and b");
  EXPECT_EQ(enumerate(Names{"a", "b", "c"}), "a, b or c");
}

}  // namespace
}  // namespace mc::base
