// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <limits>

#include "mc/field.hpp"

namespace mc::source {

/// Counts and range of samples that pass by.
class SampleRange {
 public:
  SampleRange(SampleType type, std::endian endian) : type_(type), endian_(endian) {
    seen_.min = seen_.max = std::numeric_limits<double>::quiet_NaN();
  }

  /// Samples side by side, of any alignment. Cost: at memory bandwidth, halves apart.
  void add(const std::byte* at, std::size_t n_samples);
  /// Whether there are samples on both sides of `iso`, whichever of them it belongs to itself.
  [[nodiscard]] bool spans(double iso) const { return seen_.min < iso && iso < seen_.max; }
  /// n_samples, n_nan, n_infinite, min and max; NaN where there were no finite samples.
  [[nodiscard]] const FieldStatistics& seen() const { return seen_; }

 private:
  template <class T, bool Swap>
  void add_typed(const std::byte* at, std::size_t n_samples);

  SampleType type_;
  std::endian endian_;
  FieldStatistics seen_;
};

}  // namespace mc::source
