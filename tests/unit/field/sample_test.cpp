// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numeric>
#include <vector>

#include "field/half_values.hpp"
#include "mc/field.hpp"

namespace mc {
namespace {

TEST(Half, EveryBitPatternSurvivesTheWayThroughFloat) {
  for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
    const Half h{static_cast<std::uint16_t>(bits)};
    const float f = to_float(h);
    if (std::isnan(f)) {
      EXPECT_TRUE(std::isnan(to_float(to_half(f))));
    } else {
      EXPECT_EQ(to_half(f).bits, h.bits) << bits;
    }
  }
}

TEST(Half, ArraysWidenAsOneByOne) {
  std::vector<std::uint16_t> halves(0x10000);
  std::iota(halves.begin(), halves.end(), std::uint16_t{0});
  std::vector<float> wide(halves.size());
  field::widen_halves(reinterpret_cast<const std::byte*>(halves.data()), halves.size(),
                      wide.data());
  for (std::size_t n = 0; n < halves.size(); ++n) {
    EXPECT_EQ(std::bit_cast<std::uint32_t>(wide[n]),
              std::bit_cast<std::uint32_t>(to_float(Half{halves[n]})))
        << n;
  }
}

TEST(Half, RoundsToNearestEven) {
  EXPECT_EQ(to_half(65504.F).bits, 0x7BFF);
  EXPECT_EQ(to_half(65519.F).bits, 0x7BFF);
  EXPECT_EQ(to_half(65520.F).bits, 0x7C00);
  EXPECT_EQ(to_half(1.F + 0x1p-11F).bits, 0x3C00);      // tie, to even
  EXPECT_EQ(to_half(1.F + 3 * 0x1p-11F).bits, 0x3C02);  // tie, to even
  EXPECT_EQ(to_half(0x1p-25F).bits, 0x0000);
  EXPECT_EQ(to_half(0x1.8p-25F).bits, 0x0001);
}

TEST(SampleType, NamesAndSizes) {
  EXPECT_EQ(sample_size(SampleType::i16), 2U);
  EXPECT_EQ(sample_size(SampleType::f16), 2U);
  EXPECT_EQ(sample_size(SampleType::f64), 8U);
  EXPECT_EQ(sample_type_named("u32"), SampleType::u32);
  EXPECT_EQ(sample_type_named("float"), std::nullopt);
}

TEST(Affine, AppliesAndComposes) {
  const Affine a = Affine::scale_translate({2, 3, 4}, {10, 20, 30});
  EXPECT_EQ(a({1, 1, 1}), (Vec3{12, 23, 34}));
  const Affine mirror = Affine::scale_translate({-1, 1, 1}, {0, 0, 0});
  EXPECT_EQ(mirror.after(a)({1, 1, 1}), (Vec3{-12, 23, 34}));
  EXPECT_LT(mirror.after(a).determinant(), 0);
}

}  // namespace
}  // namespace mc
