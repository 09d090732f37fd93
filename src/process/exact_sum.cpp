// SPDX-License-Identifier: MIT
#include "process/exact_sum.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace mc::process {

namespace {

constexpr std::uint64_t kLowDigit = 0xFFFFFFFF;
constexpr int kLeastExponent = -1074;  // of the last bit of the smallest double

}  // namespace

void ExactSum::add(double value) {
  if (!std::isfinite(value)) {
    finite_ = false;
    return;
  }
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const std::uint64_t exponent = bits >> 52U & 0x7FFU;
  const std::uint64_t fraction = bits & ((std::uint64_t{1} << 52U) - 1);
  // The value is mantissa * 2^(shift + kLeastExponent).
  const std::uint64_t mantissa = exponent == 0 ? fraction : fraction | std::uint64_t{1} << 52U;
  const std::uint64_t shift = exponent == 0 ? 0 : exponent - 1;
  const std::size_t digit = shift / kDigitBits;
  const std::uint64_t low = (mantissa & kLowDigit) << shift % kDigitBits;
  const std::uint64_t high = (mantissa >> kDigitBits) << shift % kDigitBits;
  const std::int64_t sign = (bits >> 63U) != 0 ? -1 : 1;
  digits_[digit] += sign * static_cast<std::int64_t>(low & kLowDigit);
  digits_[digit + 1] += sign * static_cast<std::int64_t>((low >> kDigitBits) + (high & kLowDigit));
  digits_[digit + 2] += sign * static_cast<std::int64_t>(high >> kDigitBits);
  if (++n_added_ == kMaxAdded) carry();
}

void ExactSum::add(const ExactSum& other) {
  ExactSum carried = other;
  carried.carry();
  for (std::size_t d = 0; d < kDigits; ++d) digits_[d] += carried.digits_[d];
  finite_ = finite_ && other.finite_;
  if (++n_added_ == kMaxAdded) carry();
}

/// Brings all digits but the last, which has the sign, into [0, 2^32).
void ExactSum::carry() {
  std::int64_t carried = 0;
  for (std::size_t d = 0; d + 1 < kDigits; ++d) {
    const std::int64_t digit = digits_[d] + carried;
    carried = digit >> kDigitBits;  // rounds down
    digits_[d] = digit - carried * (std::int64_t{1} << kDigitBits);
  }
  digits_[kDigits - 1] += carried;
  n_added_ = 0;
}

double ExactSum::value() const {
  if (!finite_) return std::numeric_limits<double>::quiet_NaN();
  ExactSum sum = *this;
  sum.carry();
  const bool negative = sum.digits_[kDigits - 1] < 0;
  if (negative) {
    for (std::int64_t& digit : sum.digits_) digit = -digit;
    sum.carry();
  }
  double out = 0;
  for (std::size_t d = kDigits; d-- > 0;) {
    const int exponent = static_cast<int>(kDigitBits * d) + kLeastExponent;
    out += std::ldexp(static_cast<double>(sum.digits_[d]), exponent);
  }
  return negative ? -out : out;
}

}  // namespace mc::process
