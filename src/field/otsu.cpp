// SPDX-License-Identifier: MIT
#include "field/otsu.hpp"

// Otsu's threshold on a histogram. Sums run over the bars in order, so the result is the same
// however the histogram was counted.

namespace mc::field {

std::optional<std::size_t> otsu_split(std::span<const HistogramBar> bars) {
  double n_all = 0;
  double mean = 0;
  for (const HistogramBar& bar : bars) {
    n_all += static_cast<double>(bar.count);
  }
  for (const HistogramBar& bar : bars) {
    mean += bar.value * (static_cast<double>(bar.count) / n_all);
  }
  std::optional<std::size_t> best;
  double greatest = 0;
  std::uint64_t n_lower = 0;
  double moment = 0;  // of the lower class about the mean: never positive
  for (std::size_t n = 0; n + 1 < bars.size(); ++n) {
    if (bars[n].count == 0) continue;  // splits as the bar before it does
    n_lower += bars[n].count;
    moment += (bars[n].value - mean) * (static_cast<double>(bars[n].count) / n_all);
    const double weight = static_cast<double>(n_lower) / n_all;
    if (weight >= 1) break;
    const double between = moment * moment / (weight * (1 - weight));
    if (between > greatest) {
      greatest = between;
      best = n;
    }
  }
  return best;
}

}  // namespace mc::field
