// SPDX-License-Identifier: MIT
#include "sink/shortest.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <string>

namespace mc::sink {
namespace {

template <class Number>
std::string by_library(Number x) {
  std::array<char, 40> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr};
}

std::string by_us(float x) {
  std::array<char, 40> text{};
  return {text.data(), print_shortest(text.data(), x)};
}

TEST(Shortest, FloatsAreThoseOfToChars) {
  // One float in 97, of either sign; all 222,313,873 were compared when this was written.
  const auto first = std::bit_cast<std::uint32_t>(1e-3F);
  const auto last = std::bit_cast<std::uint32_t>(1e5F);
  for (std::uint32_t bits = first; bits < last; bits += 97) {
    const auto x = std::bit_cast<float>(bits ^ (bits % 2 << 31));
    ASSERT_EQ(by_us(x), by_library(x));
  }
}

TEST(Shortest, PowersAndTheirNeighboursAreThoseOfToChars) {
  for (int e = -9; e < 17; ++e) {
    for (const float power : {std::ldexp(1.0F, e), std::pow(10.0F, static_cast<float>(e % 5))}) {
      for (const float x : {std::nextafter(power, 0.0F), power, std::nextafter(power, 1e9F)}) {
        if (is_in_fast_range(x)) {
          ASSERT_EQ(by_us(x), by_library(x));
        }
      }
    }
  }
}

TEST(Shortest, LeavesTheRestToTheLibrary) {
  for (const float x : {0.0F, 0.99999994e-3F, 1e5F, 1e30F, INFINITY, NAN}) {
    EXPECT_FALSE(is_in_fast_range(x)) << x;
    EXPECT_FALSE(is_in_fast_range(-x)) << x;
  }
}

TEST(Shortest, SmallIntegersAreThoseOfToChars) {
  const auto printed = [](std::uint32_t n) {
    std::array<char, 16> text{};
    return std::string(text.data(), print_small(text.data(), n));
  };
  for (std::uint32_t n = 0; n < 200000; ++n) {
    ASSERT_EQ(printed(n), by_library(n));
  }
  for (std::uint32_t n = 200000; n < kFastIntegers; n += 997) {
    ASSERT_EQ(printed(n), by_library(n));
  }
  EXPECT_EQ(printed(99999999), "99999999");
}

}  // namespace
}  // namespace mc::sink
