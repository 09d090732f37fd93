// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: rows of bits as vectors of words.

#if defined(MC_EXTRACT_BITS_ROW_WORDS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_EXTRACT_BITS_ROW_WORDS_INL
#undef MC_EXTRACT_BITS_ROW_WORDS_INL
#else
#define MC_EXTRACT_BITS_ROW_WORDS_INL
#endif

#include <hwy/highway.h>

#include <bit>

#include "extract/bits/bit_row.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::extraction::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::CappedTag<std::uint64_t, kWordsAtOnce>;
using WordVector = hn::Vec<Words>;

inline std::uint32_t ones(std::uint64_t word) {
  return static_cast<std::uint32_t>(std::popcount(word));
}

/// Words of a row from w on, each moved down by one sample: bit i is sample i + 1.
inline WordVector load_next(const std::uint64_t* row, std::size_t w) {
  const Words d;
  return hn::Or(hn::ShiftRight<1>(hn::LoadU(d, row + w)),
                hn::ShiftLeft<63>(hn::LoadU(d, row + w + 1)));
}

/// One such word.
inline std::uint64_t next_word(const std::uint64_t* row, std::size_t w) {
  return row[w] >> 1 | row[w + 1] << 63;
}

/// The crossed i-edges of a row, and the crossed edges from one row to another: by vectors of
/// words, or one word alone.
struct AlongRow {
  const std::uint64_t* row;
  const std::uint64_t* cells;
  [[nodiscard]] std::uint64_t word(std::size_t w) const {
    return (row[w] ^ next_word(row, w)) & cells[w];
  }
  [[nodiscard]] WordVector at(std::size_t w) const {
    const Words d;
    return hn::And(hn::Xor(hn::LoadU(d, row + w), load_next(row, w)), hn::LoadU(d, cells + w));
  }
};
struct BetweenRows {
  const std::uint64_t* a;
  const std::uint64_t* b;
  [[nodiscard]] std::uint64_t word(std::size_t w) const { return a[w] ^ b[w]; }
  [[nodiscard]] WordVector at(std::size_t w) const {
    const Words d;
    return hn::Xor(hn::LoadU(d, a + w), hn::LoadU(d, b + w));
  }
};

/// Calls f(w, word) for the words of a row that are not zero, lowest first. `n_words` is 1 or a
/// multiple of kWordsAtOnce: see BitPlane::words_in_use().
template <class Source, class F>
HWY_INLINE void for_each_word(const Source& source, std::size_t n_words, F&& f) {
  if (n_words == 1) {
    if (const std::uint64_t word = source.word(0); word != 0) f(std::size_t{0}, word);
    return;
  }
  const Words d;
  for (std::size_t first = 0; first < n_words; first += hn::Lanes(d)) {
    const WordVector v = source.at(first);
    std::uint64_t some = 0;
    hn::StoreMaskBits(d, hn::Ne(v, hn::Zero(d)), reinterpret_cast<std::uint8_t*>(&some));
    if (some == 0) {
      continue;
    }
    HWY_ALIGN std::uint64_t words[kWordsAtOnce];
    hn::Store(v, d, words);
    for (; some != 0; some &= some - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(some));
      f(first + lane, words[lane]);
    }
  }
}

template <class Source>
HWY_INLINE std::uint32_t count_row(const Source& source, std::size_t n_words) {
  std::uint32_t n = 0;
  for_each_word(source, n_words, [&](std::size_t /*w*/, std::uint64_t word) { n += ones(word); });
  return n;
}

/// Cells of a row of cells, between four rows of samples, that the surface passes through.
struct ActiveCells {
  const std::uint64_t* const* rows;
  const std::uint64_t* cells;
  [[nodiscard]] std::uint64_t word(std::size_t w) const {
    std::uint64_t any = 0;
    std::uint64_t all = ~std::uint64_t{0};
    for (std::size_t r = 0; r < 4; ++r) {
      const std::uint64_t next = next_word(rows[r], w);
      any |= rows[r][w] | next;
      all &= rows[r][w] & next;
    }
    return any & ~all & cells[w];
  }
  [[nodiscard]] WordVector at(std::size_t w) const {
    const Words d;
    WordVector any = hn::Zero(d);
    WordVector all = hn::Not(any);
    for (std::size_t r = 0; r < 4; ++r) {
      const WordVector here = hn::LoadU(d, rows[r] + w);
      const WordVector next = load_next(rows[r], w);
      any = hn::Or(any, hn::Or(here, next));
      all = hn::And(all, hn::And(here, next));
    }
    return hn::And(hn::AndNot(all, any), hn::LoadU(d, cells + w));
  }
};

/// The eight sample words of 64 cells; word c holds the cells' corner c.
struct CornerWords {
  std::uint64_t at[8];

  CornerWords(const std::uint64_t* const rows[4], std::size_t w) {
    for (std::size_t r = 0; r < 4; ++r) {
      at[2 * r] = rows[r][w];
      at[2 * r + 1] = next_word(rows[r], w);
    }
  }
  [[nodiscard]] unsigned cell_case(unsigned bit) const {
    unsigned out = 0;
    for (unsigned c = 0; c < 8; ++c) {
      out |= static_cast<unsigned>((at[c] >> bit) & 1U) << c;
    }
    return out;
  }
};

}  // namespace mc::extraction::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
