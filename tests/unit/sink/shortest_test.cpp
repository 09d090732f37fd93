// SPDX-License-Identifier: MIT
#include "sink/shortest.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

#include "sink/text.hpp"

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

TEST(Shortest, NeighboursOfShortDecimalsAreThoseOfToChars) {
  // The interval that rounds to a float has one of these at or near its ends.
  for (int digits = 1; digits < 10000; ++digits) {
    for (int places = 0; places < 7; ++places) {
      const auto x = static_cast<float>(digits / std::pow(10.0, places));
      for (const float near : {std::nextafter(x, 0.0F), x, std::nextafter(x, 1e9F)}) {
        if (is_in_fast_range(near)) {
          ASSERT_EQ(by_us(near), by_library(near));
          ASSERT_EQ(by_us(-near), by_library(-near));
        }
      }
    }
  }
}

/// A number printed as the text formats print it.
template <class Number>
std::string printed(Number x) {
  std::array<char, 40> text{};
  return {text.data(), print_number(text.data(), x)};
}

TEST(Shortest, FloatsOfAllExponentsAreThoseOfToChars) {
  std::uint32_t random = 1;
  for (std::uint32_t exponent = 0; exponent < 256; ++exponent) {
    for (int i = 0; i < 2000; ++i) {
      random = random * 1664525 + 1013904223;
      const auto x = std::bit_cast<float>(exponent << 23 | (random & 0x807FFFFF));
      ASSERT_EQ(printed(x), by_library(x));
      if (!std::isfinite(x)) continue;
      const std::string text = printed(x);
      float back = 0;
      std::from_chars(text.data(), text.data() + text.size(), back);
      ASSERT_EQ(std::bit_cast<std::uint32_t>(back), std::bit_cast<std::uint32_t>(x)) << text;
    }
  }
}

TEST(Shortest, IntegersAtPowersOfTenAreThoseOfToChars) {
  std::uint64_t power = 1;
  for (int e = 0; e < 20; ++e, power *= 10) {
    for (const std::uint64_t n : {power - 1, power, power + 1}) {
      ASSERT_EQ(printed(n), by_library(n));
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
