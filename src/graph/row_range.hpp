// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "graph/bounds.hpp"

namespace mc::graph {

/// The exact range of rows of numbers; unknown where one is infinite or NaN. Kept in lanes, of
/// which the compiler makes vectors.
class RowRange {
 public:
  RowRange() {
    lo_.fill(__builtin_inff());
    hi_.fill(-__builtin_inff());
  }

  void include(const float* row, std::size_t n) {
    std::size_t i = 0;
    for (; i + kLanes <= n; i += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) include(row[i + lane], lane);
    }
    for (; i < n; ++i) include(row[i], 0);
  }

  [[nodiscard]] Interval interval() const {
    constexpr float kMost = std::numeric_limits<float>::max();
    const float lo = *std::min_element(lo_.begin(), lo_.end());
    const float hi = *std::max_element(hi_.begin(), hi_.end());
    const bool has_nan = *std::max_element(nan_.begin(), nan_.end()) != 0;
    return !has_nan && lo >= -kMost && hi <= kMost ? Interval{lo, hi} : Interval{};
  }

 private:
  static constexpr std::size_t kLanes = 16;

  void include(float v, std::size_t lane) {
    lo_[lane] = v < lo_[lane] ? v : lo_[lane];
    hi_[lane] = v > hi_[lane] ? v : hi_[lane];
    nan_[lane] |= v != v ? 1 : 0;
  }

  std::array<float, kLanes> lo_;
  std::array<float, kLanes> hi_;
  std::array<std::int32_t, kLanes> nan_{};
};

}  // namespace mc::graph
