// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

// Rows of sample bits, 64 to a word: sample i is bit i % 64 of word i / 64.

namespace mc::extraction {

/// Rows are padded with zeros to a multiple of so many words: the widest vector, a cache line.
inline constexpr std::size_t kWordsAtOnce = 8;

/// Words of a padded row.
inline std::size_t padded_words(std::size_t n_samples) {
  return (n_samples + 64 * kWordsAtOnce - 1) / (64 * kWordsAtOnce) * kWordsAtOnce;
}

/// Word w of a row moved down by one sample: bit i is sample i + 1.
inline std::uint64_t next_samples(const std::uint64_t* row, std::size_t w, std::size_t n_words) {
  return (row[w] >> 1) | (w + 1 < n_words ? row[w + 1] << 63 : 0);
}

/// Ones for the cells, or i-edges, that start in word w of a row of n samples.
inline std::uint64_t cell_mask(std::size_t n_samples, std::size_t w) {
  const std::size_t left = n_samples - 1 - std::min(n_samples - 1, w * 64);
  return left >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << left) - 1;
}

/// The place in its row of a bit of word w.
inline std::int32_t index_in_row(std::size_t w, int bit) {
  return static_cast<std::int32_t>(w * 64) + bit;
}

/// Calls f with the number of each set bit, lowest first.
template <class F>
void for_each_bit(std::uint64_t word, F&& f) {
  for (; word != 0; word &= word - 1) {
    f(std::countr_zero(word));
  }
}

}  // namespace mc::extraction
