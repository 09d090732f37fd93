// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace mc::process {

/// A sum of doubles without rounding: the same for any order of the values and any grouping.
/// Source   Kulisch's long accumulator: an integer with digits for every bit that a double can
///          have.
class ExactSum {
 public:
  void add(double value);
  void add(const ExactSum& other);
  /// The sum as a double, within one unit in the last place; NaN if a value was not finite.
  [[nodiscard]] double value() const;

 private:
  static constexpr unsigned kDigitBits = 32;
  /// Digit d weighs 2^(32 d - 1074). The largest double has its last bit in digit 65; two digits
  /// more take what many of them add up to.
  static constexpr std::size_t kDigits = 68;
  /// One value adds less than 2^33 to a digit, whose 63 bits then hold this many.
  static constexpr std::uint32_t kMaxAdded = 1U << 29U;

  void carry();

  std::array<std::int64_t, kDigits> digits_{};
  std::uint32_t n_added_ = 0;  ///< since the last carry
  bool finite_ = true;
};

}  // namespace mc::process
