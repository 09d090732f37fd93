// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "field/order_key.hpp"
#include "field/otsu.hpp"
#include "field/radix_selection.hpp"
#include "field/sample_scan.hpp"
#include "field/visit_type.hpp"
#include "mc/field.hpp"

// Range, mean, threshold and percentiles of a volume. Types of up to 16 bits are counted value by
// value in one pass, and all else follows from the counts. Wider types take a pass for the range
// and the mean, one for the 1024 bins of the threshold, and, for percentiles, a radix selection:
// one pass for each 16 bits of keys that order as the samples do. Counts are integers and sums are
// added part by part in one order, so no result shows how many threads there were.

namespace mc {

namespace {

using field::load_sample;
using field::order_key;
using field::OrderKey;
using field::Watch;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

template <class T>
double value_of(T sample) {
  return static_cast<double>(field::number(sample));
}

/// Index, from 0, of the percentile among n sorted samples: nearest rank. n * p before the division
/// keeps whole results whole.
std::uint64_t rank_of(double percentile, std::uint64_t n) {
  assert(percentile >= 0 && percentile <= 100);
  const double rank = std::ceil(static_cast<double>(n) * percentile / 100);
  return std::min(n, std::max(std::uint64_t{1}, static_cast<std::uint64_t>(rank))) - 1;
}

// Types of 8 and 16 bits.

/// How often each value occurs, by order key. Neighbours go to different lanes, since adding twice
/// in a row to the same counter waits for memory.
template <class T>
class ValueCounts {
 public:
  static constexpr std::size_t kKeys = std::size_t{1} << (8 * sizeof(T));
  static constexpr std::size_t kLanes = sizeof(T) == 1 ? 4 : 2;
  static constexpr std::uint64_t kBytes = kLanes * kKeys * sizeof(std::uint64_t);

  template <bool Swap>
  void row(const std::byte* at, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      ++counts_[i % kLanes * kKeys + order_key(load_sample<T, Swap>(at + i * sizeof(T)))];
    }
  }
  void weighted(T value, std::uint64_t n) { counts_[order_key(value)] += n; }
  void end_part(std::size_t /*part*/) {}

  void add_to(std::vector<std::uint64_t>& sum) const {
    for (std::size_t n = 0; n < counts_.size(); ++n) sum[n % kKeys] += counts_[n];
  }

 private:
  std::vector<std::uint64_t> counts_ = std::vector<std::uint64_t>(kLanes * kKeys);
};

template <class T>
double counted_percentile(std::span<const std::uint64_t> counts, double percentile,
                          std::uint64_t n_numbers) {
  if (n_numbers == 0) return kNone;
  std::uint64_t left = rank_of(percentile, n_numbers);
  for (std::size_t key = 0; key < counts.size(); ++key) {
    const T sample = field::sample_of_key<T>(static_cast<OrderKey<T>>(key));
    if (field::is_nan(sample)) continue;
    if (left < counts[key]) return value_of(sample);
    left -= counts[key];
  }
  return kNone;
}

/// Where the upper class begins: for integers the number after the lower class's last, for halves
/// the next value that occurs.
template <class T>
double counted_otsu(std::span<const field::HistogramBar> bars) {
  if (bars.empty()) return kNone;
  const auto split = field::otsu_split(bars);
  if (!split) return bars.back().value;
  return std::is_integral_v<T> ? bars[*split].value + 1 : bars[*split + 1].value;
}

template <class T>
FieldStatistics from_counts(std::span<const std::uint64_t> counts,
                            std::span<const double> percentiles) {
  FieldStatistics out;
  std::vector<field::HistogramBar> bars;
  double sum = 0;
  std::uint64_t n_finite = 0;
  for (std::size_t key = 0; key < counts.size(); ++key) {
    const T sample = field::sample_of_key<T>(static_cast<OrderKey<T>>(key));
    out.n_samples += counts[key];
    if (field::is_nan(sample)) {
      out.n_nan += counts[key];
    } else if (!field::is_finite(sample)) {
      out.n_infinite += counts[key];
    } else if (counts[key] > 0) {
      bars.push_back({value_of(sample), counts[key]});
      sum += value_of(sample) * static_cast<double>(counts[key]);
      n_finite += counts[key];
    }
  }
  out.min = bars.empty() ? kNone : bars.front().value;
  out.max = bars.empty() ? kNone : bars.back().value;
  out.mean = bars.empty() ? kNone : sum / static_cast<double>(n_finite);
  out.otsu = counted_otsu<T>(bars);
  for (const double percentile : percentiles) {
    out.percentiles.push_back(counted_percentile<T>(counts, percentile, out.n_samples - out.n_nan));
  }
  return out;
}

template <class T>
FieldStatistics measure_counted(const VolumeReader& reader, std::span<const double> percentiles,
                                const Watch& watch) {
  std::vector<std::uint64_t> counts(ValueCounts<T>::kKeys);
  for (const auto& acc :
       field::scan<T>(reader, watch, ValueCounts<T>::kBytes, [] { return ValueCounts<T>(); })) {
    acc.add_to(counts);
  }
  return from_counts<T>(counts, percentiles);
}

// Types of 32 and 64 bits.

/// Range, counts, and the sum of each part. Eight lanes each take every eighth sample of a row.
template <class T>
class Range {
 public:
  explicit Range(std::vector<double>& part_sums) : part_sums_(&part_sums) {
    lows_.fill(std::numeric_limits<T>::max());
    highs_.fill(std::numeric_limits<T>::lowest());
  }

  template <bool Swap>
  void row(const std::byte* at, std::size_t n) {
    std::size_t i = 0;
    for (; i + kLanes <= n; i += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        add(load_sample<T, Swap>(at + (i + lane) * sizeof(T)), lane);
      }
    }
    for (; i < n; ++i) add(load_sample<T, Swap>(at + i * sizeof(T)), i % kLanes);
    n_samples += n;
  }
  void weighted(T value, std::uint64_t n) {
    add(value, 0);
    n_samples += n;
    n_finite_[0] += field::is_finite(value) ? n - 1 : 0;
    n_nan_[0] += field::is_nan(value) ? n - 1 : 0;
    if (field::is_finite(value)) sums_[0] += value_of(value) * static_cast<double>(n - 1);
  }
  void end_part(std::size_t part) {
    (*part_sums_)[part] = std::accumulate(sums_.begin(), sums_.end(), 0.0);
    sums_.fill(0);
  }

  [[nodiscard]] T low() const { return *std::min_element(lows_.begin(), lows_.end()); }
  [[nodiscard]] T high() const { return *std::max_element(highs_.begin(), highs_.end()); }
  [[nodiscard]] std::uint64_t n_finite() const { return total(n_finite_); }
  [[nodiscard]] std::uint64_t n_nan() const { return total(n_nan_); }

  std::uint64_t n_samples = 0;

 private:
  static constexpr std::size_t kLanes = 8;
  using Counts = std::array<std::uint64_t, kLanes>;

  static std::uint64_t total(const Counts& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  }
  void add(T value, std::size_t lane) {
    const bool finite = field::is_finite(value);
    n_finite_[lane] += finite ? 1 : 0;
    n_nan_[lane] += field::is_nan(value) ? 1 : 0;
    sums_[lane] += finite ? value_of(value) : 0.0;
    lows_[lane] = finite && value < lows_[lane] ? value : lows_[lane];
    highs_[lane] = finite && value > highs_[lane] ? value : highs_[lane];
  }

  std::vector<double>* part_sums_;
  std::array<T, kLanes> lows_;
  std::array<T, kLanes> highs_;
  std::array<double, kLanes> sums_{};
  Counts n_finite_{};
  Counts n_nan_{};
};

constexpr std::size_t kBins = 1024;

/// Equal parts of [low, high], low < high. Where the width overflows, all is halved.
class Binning {
 public:
  Binning(double low, double high)
      : scale_(std::isfinite(high - low) ? 1.0 : 0.5),
        low_(low * scale_),
        width_(high * scale_ - low * scale_) {}

  [[nodiscard]] std::size_t bin(double value) const {
    const double at = (value * scale_ - low_) / width_ * static_cast<double>(kBins);
    return std::min(kBins - 1, static_cast<std::size_t>(at));
  }
  [[nodiscard]] double upper_edge(std::size_t bin_index) const {
    const double part = static_cast<double>(bin_index + 1) / static_cast<double>(kBins);
    return (low_ + width_ * part) / scale_;
  }

 private:
  double scale_;
  double low_;
  double width_;
};

template <class T>
class BinCounts {
 public:
  explicit BinCounts(const Binning& binning) : binning_(binning) {}

  template <bool Swap>
  void row(const std::byte* at, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) weighted(load_sample<T, Swap>(at + i * sizeof(T)), 1);
  }
  void weighted(T value, std::uint64_t n) {
    if (field::is_finite(value)) counts_[binning_.bin(value_of(value))] += n;
  }
  void end_part(std::size_t /*part*/) {}

  void add_to(std::array<std::uint64_t, kBins>& sum) const {
    for (std::size_t n = 0; n < kBins; ++n) sum[n] += counts_[n];
  }

 private:
  Binning binning_;
  std::array<std::uint64_t, kBins> counts_{};
};

template <class T>
double binned_otsu(const VolumeReader& reader, double low, double high, const Watch& watch) {
  if (!(low < high)) return low;  // one value; or none, and then both are NaN
  const Binning binning(low, high);
  std::array<std::uint64_t, kBins> counts{};
  for (const auto& acc :
       field::scan<T>(reader, watch, sizeof(BinCounts<T>), [&] { return BinCounts<T>(binning); })) {
    acc.add_to(counts);
  }
  std::vector<field::HistogramBar> bars;
  for (std::size_t n = 0; n < kBins; ++n) bars.push_back({static_cast<double>(n), counts[n]});
  const auto split = field::otsu_split(bars);
  return split ? binning.upper_edge(*split) : high;
}

template <class T>
std::vector<double> selected(const VolumeReader& reader, std::span<const double> percentiles,
                             std::uint64_t n_numbers, const Watch& watch) {
  if (n_numbers == 0) return std::vector<double>(percentiles.size(), kNone);
  std::vector<std::uint64_t> ranks;
  ranks.reserve(percentiles.size());
  for (const double p : percentiles) ranks.push_back(rank_of(p, n_numbers));
  std::vector<double> out;
  out.reserve(ranks.size());
  for (const T sample : field::samples_of_ranks<T>(reader, ranks, watch)) {
    out.push_back(value_of(sample));
  }
  return out;
}

template <class T>
FieldStatistics measure_wide(const VolumeReader& reader, std::span<const double> percentiles,
                             const Watch& watch) {
  const std::size_t n_parts = field::part_count(reader);
  std::vector<double> sums(n_parts);
  FieldStatistics out;
  std::uint64_t n_finite = 0;
  out.min = out.max = out.mean = kNone;
  for (const auto& acc :
       field::scan<T>(reader, watch, sizeof(Range<T>), [&] { return Range<T>(sums); })) {
    out.n_samples += acc.n_samples;
    out.n_nan += acc.n_nan();
    n_finite += acc.n_finite();
    if (acc.n_finite() == 0) continue;
    out.min = std::fmin(out.min, value_of(acc.low()));  // fmin and fmax prefer a number to NaN
    out.max = std::fmax(out.max, value_of(acc.high()));
  }
  out.min += 0.0;  // turns -0 into 0: which of them came first depends on the threads
  out.max += 0.0;
  out.n_infinite = out.n_samples - out.n_nan - n_finite;
  if (n_finite > 0) {
    out.mean = std::accumulate(sums.begin(), sums.end(), 0.0) / static_cast<double>(n_finite);
  }
  out.otsu = binned_otsu<T>(reader, out.min, out.max, watch);
  out.percentiles = selected<T>(reader, percentiles, out.n_samples - out.n_nan, watch);
  return out;
}

/// How often the samples are read, for the progress.
std::uint64_t n_passes(std::size_t sample_bytes, std::size_t n_percentiles) {
  return sample_bytes <= 2 ? 1 : 2 + field::selection_passes(sample_bytes, n_percentiles);
}

}  // namespace

FieldStatistics measure_field(const VolumeReader& reader, std::span<const double> percentiles,
                              Progress& progress, const std::stop_token& stop,
                              std::uint64_t memory_bytes) {
  const SampleType type = volume_of(reader).type;
  const std::uint64_t n_samples = field::scan_length(reader);
  progress.begin("statistics", n_samples * n_passes(sample_size(type), percentiles.size()),
                 "samples");
  const Watch watch{progress, stop, memory_beside(held_bytes_of(reader), memory_bytes)};
  return field::visit_type(type, [&]<class T>(field::TypeTag<T>) {
    if constexpr (sizeof(T) <= 2) {
      return measure_counted<T>(reader, percentiles, watch);
    } else {
      return measure_wide<T>(reader, percentiles, watch);
    }
  });
}

}  // namespace mc
