// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

// Float arithmetic that gives the same bits everywhere: IEEE-exact operations in a fixed order, no
// fused multiply-add, no branch that a vector machine could not turn into a select, and nothing of
// the C library (std::sqrt is exact by IEEE 754, std::abs is a bit).

namespace mc::graph {

/// IEEE floor, also of -0, infinities and NaN.
[[nodiscard]] inline float exact_floor(float v) noexcept {
  const bool whole = !(std::abs(v) < 0x1p23F);  // also NaN
  const float safe = whole ? 0.0F : v;
  const auto cut = static_cast<float>(static_cast<std::int32_t>(safe));
  const float lower = cut > safe ? cut - 1.0F : cut;
  const std::uint32_t sign = std::bit_cast<std::uint32_t>(safe) & 0x80000000U;
  return whole ? v : std::bit_cast<float>(std::bit_cast<std::uint32_t>(lower) | sign);
}

/// b < a ? b : a. A NaN in b is passed over, one in a stays.
[[nodiscard]] inline float least(float a, float b) noexcept { return b < a ? b : a; }
[[nodiscard]] inline float greatest(float a, float b) noexcept { return b > a ? b : a; }

/// NaN stays NaN.
[[nodiscard]] inline float clamped(float v, float lo, float hi) noexcept {
  const float raised = v < lo ? lo : v;
  return raised > hi ? hi : raised;
}

/// Steps of p[0] from p[3] on, flat up to p[1] of a step, then rising by p[2] a step. Never falls.
[[nodiscard]] inline float terraced(float v, const std::array<float, 6>& p) noexcept {
  const float level = (v - p[3]) / p[0];
  const float whole = exact_floor(level);
  const float rise = least(greatest((level - whole) - p[1], 0.0F) * p[2], 1.0F);
  return (whole + rise) * p[0] + p[3];
}

/// Sine of radians.
/// Error    at most 2e-7 for |v| <= 8192; then it grows with |v|, as the spacing of floats does;
///          0 from 2^22 on. NaN and infinities give NaN.
/// Source   Cody and Waite's reduction by a multiple of pi in three parts, Taylor's series to r^11.
[[nodiscard]] inline float exact_sin(float v) noexcept {
  constexpr float kPiHigh = 3.140625F;  // 8 bits: its product with an integer below 2^16 is exact
  constexpr float kPiMid = 0x1.fap-11F;
  constexpr float kPiLow = 0x1.54442ep-19F;
  const bool huge = !(std::abs(v) < 0x1p22F);
  const float safe = huge ? 0.0F : v;
  const float turns = exact_floor(safe * 0.318309886F + 0.5F);
  const float reduced = ((safe - turns * kPiHigh) - turns * kPiMid) - turns * kPiLow;
  const float r = clamped(reduced, -1.57079637F, 1.57079637F);
  const float q = r * r;
  float series = -2.50521084e-8F;
  series = series * q + 2.75573192e-6F;
  series = series * q + -1.98412698e-4F;
  series = series * q + 8.33333333e-3F;
  series = series * q + -1.66666667e-1F;
  const float sine = clamped(r + (r * q) * series, -1.0F, 1.0F);
  const bool odd = (static_cast<std::int32_t>(turns) & 1) != 0;
  const float result = odd ? -sine : sine;
  return huge ? (v - v) : result;
}

/// Base-2 logarithm of a positive normal number.
[[nodiscard]] inline float exact_log2(float v) noexcept {
  const auto bits = std::bit_cast<std::int32_t>(v);
  const std::int32_t exponent = (bits - 0x3F3504F3) >> 23;  // mantissa in [sqrt(1/2), sqrt(2))
  const auto m = std::bit_cast<float>(bits - exponent * (1 << 23));
  const float s = (m - 1.0F) / (m + 1.0F);
  const float q = s * s;
  float series = 0.320598898F;  // 2 / (9 ln 2)
  series = series * q + 0.412198583F;
  series = series * q + 0.577078016F;
  series = series * q + 0.961796694F;
  series = series * q + 2.88539008F;
  return static_cast<float>(exponent) + s * series;
}

/// 2^v for v in [-126, 128).
[[nodiscard]] inline float exact_exp2(float v) noexcept {
  const float n = exact_floor(v + 0.5F);
  const float f = v - n;
  float series = 1.52527338e-5F;
  series = series * f + 1.54035304e-4F;
  series = series * f + 1.33335581e-3F;
  series = series * f + 9.61812911e-3F;
  series = series * f + 5.55041087e-2F;
  series = series * f + 2.40226507e-1F;
  series = series * f + 6.93147181e-1F;
  series = series * f + 1.0F;
  const auto half = static_cast<std::int32_t>(n) >> 1;  // in two steps: 2^128 alone has no float
  const std::int32_t rest = static_cast<std::int32_t>(n) - half;
  const auto first = std::bit_cast<float>((half + 127) * (1 << 23));
  const auto second = std::bit_cast<float>((rest + 127) * (1 << 23));
  return (series * first) * second;
}

/// a to the power b, with C's meaning of zeros, infinities and signs, but NaN stays NaN.
/// Error    relative, at most 2e-7 * (1 + |b log2 a|). Results below 2^-126 are 0; a is 0 below it.
/// Source   atanh series for log2 on [sqrt(1/2), sqrt(2)), Taylor's series for 2^f, |f| <= 1/2.
[[nodiscard]] inline float exact_pow(float a, float b) noexcept {
  constexpr float kInfinity = __builtin_inff();
  const float size = std::abs(a);
  const bool zero = size < 0x1p-126F;
  const bool regular = !zero && size < kInfinity;
  const float log = exact_log2(regular ? size : 1.0F);
  const float product = log == 0.0F ? 0.0F : b * log;
  const float exponent = regular ? product : (zero ? b * -kInfinity : b * kInfinity);
  const bool in_range = exponent >= -126.0F && exponent < 128.0F;
  const float power = exact_exp2(in_range ? exponent : 0.0F);
  const float extreme = exponent >= 128.0F ? kInfinity : 0.0F;
  const float magnitude = in_range ? power : extreme;
  const bool whole = exact_floor(b) == b;
  const float halved = b * 0.5F;
  const bool odd = whole && exact_floor(halved) != halved;
  const bool negative = a < 0.0F && !zero;
  const float signed_power = negative && odd ? -magnitude : magnitude;
  const float real = negative && !whole ? b - b + __builtin_nanf("") : signed_power;
  const float nan = a + b;  // only looked at when one of them is NaN
  return a != a || b != b ? nan : (b == 0.0F ? 1.0F : real);
}

}  // namespace mc::graph
