// SPDX-License-Identifier: MIT
#include "mesh/float_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "base/simd_target.hpp"

namespace mc::mesh {
namespace {

std::string by_library(float x) {
  std::array<char, 40> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr};
}

bool is_in_range(float x) {
  const float size = std::fabs(x);
  return x == 0 || (size >= 1e-3F && size < 1e5F);
}

/// Compares with the library, on the SIMD target that is chosen; scalar and SVE leave all to the
/// caller.
void expect_library_text(const std::vector<float>& x, const std::string& target) {
  std::vector<FloatText> texts(x.size());
  print_floats(x.data(), x.size(), texts.data());
  for (std::size_t n = 0; n < x.size(); ++n) {
    const std::string text(texts[n].text.data(), texts[n].n);
    const bool printed = is_in_range(x[n]) && target != "scalar" && !target.starts_with("sve");
    ASSERT_EQ(text, printed ? by_library(x[n]) : "") << x[n] << " on " << target;
  }
}

template <class Check>
void on_every_target(Check check) {
  for (const std::string& target : base::simd_targets()) {
    ASSERT_TRUE(base::set_simd_target(target));
    check(target);
  }
  base::reset_simd_target();
}

TEST(FloatText, IsThatOfToChars) {
  // One float in 997, of either sign, a little beyond the range; all 222,313,873 were compared on
  // AVX-512 when this was written.
  const auto first = std::bit_cast<std::uint32_t>(0.9e-3F);
  const auto last = std::bit_cast<std::uint32_t>(1.1e5F);
  std::vector<float> x;
  for (std::uint32_t bits = first; bits < last; bits += 997) {
    x.push_back(std::bit_cast<float>(bits ^ (bits % 2 << 31)));
  }
  on_every_target([&](const std::string& target) { expect_library_text(x, target); });
}

TEST(FloatText, OfPowersAndTheirNeighboursIsThatOfToChars) {
  std::vector<float> x;
  for (int e = -11; e < 18; ++e) {
    for (const float power : {std::ldexp(1.0F, e), std::pow(10.0F, static_cast<float>(e % 6))}) {
      for (const float near : {std::nextafter(power, 0.0F), power, std::nextafter(power, 1e9F)}) {
        x.insert(x.end(), {near, -near});
      }
    }
  }
  on_every_target([&](const std::string& target) { expect_library_text(x, target); });
}

TEST(FloatText, LeavesTheRestToTheCaller) {
  const std::vector<float> x{0.0F,      -0.0F, 0.99999994e-3F, 1e5F,   1e30F, INFINITY,
                             -INFINITY, NAN,   -NAN,           1e-45F, 7.0F};
  on_every_target([&](const std::string& target) { expect_library_text(x, target); });
}

TEST(FloatText, WritesNoMoreThanItShould) {
  on_every_target([](const std::string& target) {
    for (std::size_t n = 0; n < 40; ++n) {
      const std::vector<float> x(n, 1.5F);
      std::vector<FloatText> texts(n + 1);
      texts[n].n = 99;
      print_floats(x.data(), n, texts.data());
      EXPECT_EQ(texts[n].n, 99) << n << " on " << target;
    }
  });
}

}  // namespace
}  // namespace mc::mesh
