// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace mc::field {

/// One bar of a histogram; bars are given in increasing order of `value`.
struct HistogramBar {
  double value;
  std::uint64_t count;
};

/// The last bar of the lower class where the variance between the two classes is greatest; the
/// lowest of several. Nothing where fewer than two bars hold samples.
/// Source   Otsu, "A threshold selection method from gray-level histograms", IEEE SMC 1979.
std::optional<std::size_t> otsu_split(std::span<const HistogramBar> bars);

}  // namespace mc::field
