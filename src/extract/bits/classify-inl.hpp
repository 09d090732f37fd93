// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see classify.hpp for what the function does.

#if defined(MC_EXTRACT_BITS_CLASSIFY_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_EXTRACT_BITS_CLASSIFY_INL
#undef MC_EXTRACT_BITS_CLASSIFY_INL
#else
#define MC_EXTRACT_BITS_CLASSIFY_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "extract/bits/classify.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::extraction::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128

/// A sample at a time: what MC_SIMD=scalar runs, and machines without vectors.
template <class T, bool Swap, bool NanAbove>
class WordClassifier {
 public:
  explicit WordClassifier(const Threshold& threshold) : threshold_(threshold) {}
  std::uint64_t word(const std::byte* samples) const { return part(samples, 64); }
  std::uint64_t row_end(const std::byte* row, std::size_t n) const {
    return part(row + (n - n % 64) * sizeof(T), n % 64);
  }

 private:
  std::uint64_t part(const std::byte* samples, std::size_t n) const {
    std::uint64_t word = 0;
    for (std::size_t b = 0; b < n; ++b) {
      const T sample = field::load_sample<T, Swap>(samples + b * sizeof(T));
      word |= std::uint64_t{is_above(sample, threshold_)} << b;
    }
    return word;
  }

  const Threshold& threshold_;
};

#else

/// Reverses the bytes of every lane.
template <class D, class V>
V byte_swapped(D d, V v) {
  constexpr std::size_t kSize = sizeof(hn::TFromD<D>);
  const hn::Repartition<std::uint8_t, D> bytes;
  alignas(16) static constexpr std::uint8_t kOrder2[16] = {1, 0, 3,  2,  5,  4,  7,  6,
                                                           9, 8, 11, 10, 13, 12, 15, 14};
  alignas(16) static constexpr std::uint8_t kOrder4[16] = {3,  2,  1, 0, 7,  6,  5,  4,
                                                           11, 10, 9, 8, 15, 14, 13, 12};
  alignas(16) static constexpr std::uint8_t kOrder8[16] = {7,  6,  5,  4,  3,  2,  1, 0,
                                                           15, 14, 13, 12, 11, 10, 9, 8};
  const std::uint8_t* order = kSize == 2 ? kOrder2 : kSize == 4 ? kOrder4 : kOrder8;
  return hn::BitCast(d, hn::TableLookupBytes(hn::BitCast(bytes, v), hn::LoadDup128(bytes, order)));
}

/// Vectors of samples from unaligned bytes, as the numbers to compare: Half widens to float.
template <class T, bool Swap>
struct VectorLoader {
  using D = hn::ScalableTag<Number<T> >;

  static auto load(D d, const std::byte* at) {
    if constexpr (std::is_same_v<T, Half>) {
      const hn::Rebind<std::uint16_t, D> narrow;
      const hn::Rebind<hwy::float16_t, D> half;
      auto bits = hn::LoadU(narrow, reinterpret_cast<const std::uint16_t*>(at));
      if constexpr (Swap) {
        bits = hn::Or(hn::ShiftLeft<8>(bits), hn::ShiftRight<8>(bits));
      }
      return hn::PromoteTo(d, hn::BitCast(half, bits));
    } else {
      auto v = hn::LoadU(d, reinterpret_cast<const T*>(at));
      if constexpr (Swap) {
        v = byte_swapped(d, v);
      }
      return v;
    }
  }
};

template <bool NanAbove, class V>
auto above_mask(V v, V level) {
  if constexpr (std::is_floating_point_v<hn::TFromV<V> > && !NanAbove) {
    return hn::Ge(v, level);
  } else if constexpr (std::is_floating_point_v<hn::TFromV<V> >) {
    return hn::Not(hn::Lt(v, level));
  } else {
    return hn::Not(hn::Gt(level, v));
  }
}

/// Vectors of samples to words of bits.
template <class T, bool Swap, bool NanAbove>
class WordClassifier {
 public:
  explicit WordClassifier(const Threshold& threshold)
      : threshold_(threshold), level_(hn::Set(D(), threshold.level.as<Number<T> >())) {}

  /// The bits of 64 samples.
  std::uint64_t word(const std::byte* samples) const {
    std::uint64_t word = 0;
    for (std::size_t b = 0; b < 64; b += hn::Lanes(D())) {
      word |= bits(samples + b * sizeof(T)) << b;
    }
    return word;
  }

  /// The bits of the last n % 64 samples of a row of n. The last vector ends with the row.
  std::uint64_t row_end(const std::byte* row, std::size_t n) const {
    const std::size_t lanes = hn::Lanes(D());
    std::uint64_t word = 0;
    std::size_t at = n - n % 64;
    for (; at + lanes <= n; at += lanes) {
      word |= bits(row + at * sizeof(T)) << (at % 64);
    }
    if (at < n && lanes <= n) {
      word |= bits(row + (n - lanes) * sizeof(T)) >> (at + lanes - n) << (at % 64);
      at = n;
    }
    for (; at < n; ++at) {
      const T sample = field::load_sample<T, Swap>(row + at * sizeof(T));
      word |= std::uint64_t{is_above(sample, threshold_)} << (at % 64);
    }
    return word;
  }

 private:
  using D = typename VectorLoader<T, Swap>::D;

  /// The bits of one vector.
  std::uint64_t bits(const std::byte* samples) const {
    const D d;
    std::uint64_t out = 0;
    const auto v = VectorLoader<T, Swap>::load(d, samples);
    hn::StoreMaskBits(d, above_mask<NanAbove>(v, level_), reinterpret_cast<std::uint8_t*>(&out));
    return out;
  }

  const Threshold& threshold_;
  hn::Vec<D> level_;
};

#endif

/// Rows that are read side by side. A core prefetches by the page, and waits less for memory when
/// several pages are on their way: with eight streams it reads a third more in the same time than
/// with one.
constexpr std::size_t kStreams = 8;

template <class T, bool Swap, bool NanAbove>
void classify_typed(const Threshold& threshold, const SampleRows& rows, std::uint64_t* words,
                    std::size_t words_per_row) {
  const WordClassifier<T, Swap, NanAbove> classify(threshold);
  const std::size_t n_whole = rows.n_samples / 64;
  const std::size_t band = (rows.n_rows + kStreams - 1) / kStreams;
  for (std::size_t r = 0; r < band; ++r) {
    std::array<const std::byte*, kStreams> from;
    std::array<std::uint64_t*, kStreams> to;
    std::size_t n = 0;
    for (std::size_t j = r; j < rows.n_rows; j += band) {
      from[n] = rows.first + j * rows.stride_bytes;
      to[n] = words + j * words_per_row;
      ++n;
    }
    for (std::size_t w = 0; w < n_whole; ++w) {
      for (std::size_t s = 0; s < n; ++s) {
        to[s][w] = classify.word(from[s] + w * 64 * sizeof(T));
      }
    }
    for (std::size_t s = 0; s < n && rows.n_samples % 64 != 0; ++s) {
      to[s][n_whole] = classify.row_end(from[s], rows.n_samples);
    }
  }
}

void classify_rows(const Threshold& threshold, const SampleRows& rows, std::uint64_t* words,
                   std::size_t words_per_row) {
  if (threshold.none_above) {
    for (std::size_t j = 0; j < rows.n_rows; ++j) {
      std::fill_n(words + j * words_per_row, (rows.n_samples + 63) / 64, 0);
    }
    return;
  }
  field::visit_type(threshold.type, [&]<class T>(field::TypeTag<T> /*tag*/) {
    constexpr bool kHasNan = std::is_floating_point_v<Number<T> >;
    const bool nan_above = kHasNan && threshold.nan_above;
    if (threshold.swap) {
      nan_above ? classify_typed<T, true, kHasNan>(threshold, rows, words, words_per_row)
                : classify_typed<T, true, false>(threshold, rows, words, words_per_row);
    } else {
      nan_above ? classify_typed<T, false, kHasNan>(threshold, rows, words, words_per_row)
                : classify_typed<T, false, false>(threshold, rows, words, words_per_row);
    }
  });
}

}  // namespace mc::extraction::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
