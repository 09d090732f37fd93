// SPDX-License-Identifier: MIT
#include "source/stream/sample_range.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "field/visit_type.hpp"

// Blocks of samples in lanes, which compilers turn into vectors. What is rare, infinities among
// them, is looked at again sample by sample.

namespace mc::source {

namespace {

constexpr std::size_t kLaneBytes = 64;

/// Counts and range of some samples, infinities in the range.
template <class N>
struct Extremes {
  N lo = std::numeric_limits<N>::has_infinity ? std::numeric_limits<N>::infinity()
                                              : std::numeric_limits<N>::max();
  N hi = std::numeric_limits<N>::has_infinity ? -std::numeric_limits<N>::infinity()
                                              : std::numeric_limits<N>::lowest();
  std::uint32_t n_nan = 0;

  void add(N v) {
    lo = v < lo ? v : lo;
    hi = v > hi ? v : hi;
    if constexpr (std::is_floating_point_v<N>) n_nan += std::isnan(v) ? 1U : 0U;
  }
};

template <class T, bool Swap>
auto number_at(const std::byte* at) {
  return field::number(field::load_sample<T, Swap>(at));
}

template <class T, bool Swap>
auto extremes_of(const std::byte* at, std::size_t n) {
  using N = decltype(number_at<T, Swap>(at));
  constexpr std::size_t kLanes = kLaneBytes / sizeof(N);
  const Extremes<N> none;
  std::array<N, kLanes> lo, hi;
  std::array<std::uint32_t, kLanes> n_nan{};
  lo.fill(none.lo);
  hi.fill(none.hi);
  std::size_t i = 0;
  for (; i + kLanes <= n; i += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const N v = number_at<T, Swap>(at + (i + l) * sizeof(T));
      lo[l] = v < lo[l] ? v : lo[l];
      hi[l] = v > hi[l] ? v : hi[l];
      if constexpr (std::is_floating_point_v<N>) n_nan[l] += std::isnan(v) ? 1U : 0U;
    }
  }
  Extremes<N> out;
  for (std::size_t l = 0; l < kLanes; ++l) {
    out.lo = std::min(out.lo, lo[l]);
    out.hi = std::max(out.hi, hi[l]);
    out.n_nan += n_nan[l];
  }
  for (; i < n; ++i) out.add(number_at<T, Swap>(at + i * sizeof(T)));
  return out;
}

void include(FieldStatistics& seen, double value) {
  seen.min = value < seen.min || std::isnan(seen.min) ? value : seen.min;
  seen.max = value > seen.max || std::isnan(seen.max) ? value : seen.max;
}

}  // namespace

template <class T, bool Swap>
void SampleRange::add_typed(const std::byte* at, std::size_t n_samples) {
  constexpr std::size_t kBlock = std::size_t{1} << 14U;
  for (std::size_t first = 0; first < n_samples; first += kBlock) {
    const std::size_t n = std::min(kBlock, n_samples - first);
    const std::byte* block = at + first * sizeof(T);
    const auto extremes = extremes_of<T, Swap>(block, n);
    seen_.n_samples += n;
    seen_.n_nan += extremes.n_nan;
    const auto lo = static_cast<double>(extremes.lo);
    const auto hi = static_cast<double>(extremes.hi);
    if (extremes.n_nan == n) continue;
    if (std::isfinite(lo) && std::isfinite(hi)) {
      include(seen_, lo);
      include(seen_, hi);
      continue;
    }
    for (std::size_t i = 0; i < n; ++i) {
      const auto value = static_cast<double>(number_at<T, Swap>(block + i * sizeof(T)));
      if (std::isfinite(value)) include(seen_, value);
      seen_.n_infinite += std::isinf(value) ? 1U : 0U;
    }
  }
}

void SampleRange::add(const std::byte* at, std::size_t n_samples) {
  field::visit_type(type_, [&]<class T>(field::TypeTag<T>) {
    if (endian_ == std::endian::native) {
      add_typed<T, false>(at, n_samples);
    } else {
      add_typed<T, true>(at, n_samples);
    }
  });
}

}  // namespace mc::source
