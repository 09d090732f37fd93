// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see row_kernels.hpp for what the functions do.

#if defined(MC_EXTRACT_ROW_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_EXTRACT_ROW_KERNELS_INL
#undef MC_EXTRACT_ROW_KERNELS_INL
#else
#define MC_EXTRACT_ROW_KERNELS_INL
#endif

#include <hwy/highway.h>

#include <bit>
#include <cstring>
#include <type_traits>

#include "extract/bit_row.hpp"
#include "extract/case_table.hpp"
#include "extract/row_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::extraction {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Without vectors a sample at a time: what MC_SIMD=scalar runs, and old machines.
template <class T, bool Swap>
void classify_row_scalar(const Threshold& threshold, const std::byte* samples, std::size_t n,
                         std::uint64_t* words) {
  for (std::size_t first = 0; first < n; first += 64) {
    const std::size_t end = n - first < 64 ? n - first : 64;
    std::uint64_t word = 0;
    for (std::size_t b = 0; b < end; ++b) {
      const T sample = field::load_sample<T, Swap>(samples + (first + b) * sizeof(T));
      word |= std::uint64_t{is_above(sample, threshold)} << b;
    }
    words[first / 64] = word;
  }
}

#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128

template <class T, bool Swap>
void classify_row(const Threshold& threshold, const std::byte* samples, std::size_t n,
                  std::uint64_t* words) {
  classify_row_scalar<T, Swap>(threshold, samples, n, words);
}

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

template <class T, bool Swap, bool NanAbove>
void classify_row_vector(const Threshold& threshold, const std::byte* samples, std::size_t n,
                         std::uint64_t* words) {
  using Loader = VectorLoader<T, Swap>;
  const typename Loader::D d;
  const std::size_t lanes = hn::Lanes(d);
  const auto level = hn::Set(d, threshold.level.as<Number<T> >());
  const std::size_t n_whole = n / 64;
  for (std::size_t w = 0; w < n_whole; ++w) {
    std::uint64_t word = 0;
    const std::byte* at = samples + w * 64 * sizeof(T);
    for (std::size_t b = 0; b < 64; b += lanes) {
      std::uint64_t bits = 0;
      const auto mask = above_mask<NanAbove>(Loader::load(d, at + b * sizeof(T)), level);
      hn::StoreMaskBits(d, mask, reinterpret_cast<std::uint8_t*>(&bits));
      word |= bits << b;
    }
    words[w] = word;
  }
  if (n % 64 != 0) {
    classify_row_scalar<T, Swap>(threshold, samples + n_whole * 64 * sizeof(T), n % 64,
                                 words + n_whole);
  }
}

template <class T, bool Swap>
void classify_row(const Threshold& threshold, const std::byte* samples, std::size_t n,
                  std::uint64_t* words) {
  if (threshold.nan_above) {
    classify_row_vector<T, Swap, true>(threshold, samples, n, words);
  } else {
    classify_row_vector<T, Swap, false>(threshold, samples, n, words);
  }
}

#endif

template <class T, bool Swap>
void classify_typed(const Threshold& threshold, const SampleRows& rows, std::uint64_t* words,
                    std::size_t words_per_row) {
  for (std::size_t j = 0; j < rows.n_rows; ++j) {
    classify_row<T, Swap>(threshold, rows.first + j * rows.stride_bytes, rows.n_samples,
                          words + j * words_per_row);
  }
}

void classify_rows(const Threshold& threshold, const SampleRows& rows, std::uint64_t* words,
                   std::size_t words_per_row) {
  if (threshold.none_above) {
    std::memset(words, 0, rows.n_rows * words_per_row * sizeof *words);
    return;
  }
  field::visit_type(threshold.type, [&]<class T>(field::TypeTag<T> /*tag*/) {
    if (threshold.swap) {
      classify_typed<T, true>(threshold, rows, words, words_per_row);
    } else {
      classify_typed<T, false>(threshold, rows, words, words_per_row);
    }
  });
}

inline std::uint32_t ones(std::uint64_t word) {
  return static_cast<std::uint32_t>(std::popcount(word));
}

std::uint32_t number_plane(const BitPlane& plane, std::uint32_t next, std::uint32_t* i_start,
                           std::uint32_t* j_start) {
  for (std::size_t j = 0; j < plane.n_rows; ++j) {
    const std::uint64_t* row = plane.row(j);
    i_start[j] = next;
    for (std::size_t w = 0; w < plane.words_per_row; ++w) {
      next += ones((row[w] ^ next_samples(row, w, plane.words_per_row)) &
                   cell_mask(plane.n_samples, w));
    }
    j_start[j] = next;
    if (j + 1 < plane.n_rows) {
      const std::uint64_t* above = plane.row(j + 1);
      for (std::size_t w = 0; w < plane.words_per_row; ++w) {
        next += ones(row[w] ^ above[w]);
      }
    }
  }
  return next;
}

std::uint32_t number_between(const BitPlane& lower, const BitPlane& upper, std::uint32_t next,
                             std::uint32_t* k_start) {
  for (std::size_t j = 0; j < lower.n_rows; ++j) {
    const std::uint64_t* a = lower.row(j);
    const std::uint64_t* b = upper.row(j);
    k_start[j] = next;
    for (std::size_t w = 0; w < lower.words_per_row; ++w) {
      next += ones(a[w] ^ b[w]);
    }
  }
  return next;
}

/// The eight sample words of 64 cells; word c holds the cells' corner c.
struct CornerWords {
  std::uint64_t at[8];

  CornerWords(const std::uint64_t* const rows[4], std::size_t w, std::size_t n_words) {
    for (std::size_t r = 0; r < 4; ++r) {
      at[2 * r] = rows[r][w];
      at[2 * r + 1] = next_samples(rows[r], w, n_words);
    }
  }
  [[nodiscard]] std::uint64_t active() const {
    std::uint64_t any = 0;
    std::uint64_t all = ~std::uint64_t{0};
    for (const std::uint64_t word : at) {
      any |= word;
      all &= word;
    }
    return any & ~all;
  }
  [[nodiscard]] unsigned cell_case(unsigned bit) const {
    unsigned out = 0;
    for (unsigned c = 0; c < 8; ++c) {
      out |= static_cast<unsigned>((at[c] >> bit) & 1U) << c;
    }
    return out;
  }
};

/// The twelve vertex ids of a cell from eight rows of crossed edges: four of i-edges, then two each
/// of j- and k-edges, which the cell uses at its bit and at the next.
struct CellIds {
  std::uint32_t next[8];  ///< id of the first crossed edge of each row in this word
  std::uint64_t crossed[8];

  void set_words(const CornerWords& s, std::uint64_t mask) {
    for (std::size_t r = 0; r < 4; ++r) {
      crossed[r] = (s.at[2 * r] ^ s.at[2 * r + 1]) & mask;
    }
    crossed[4] = s.at[0] ^ s.at[2];
    crossed[5] = s.at[4] ^ s.at[6];
    crossed[6] = s.at[0] ^ s.at[4];
    crossed[7] = s.at[2] ^ s.at[6];
  }
  void pass_word() {
    for (std::size_t r = 0; r < 8; ++r) {
      next[r] += ones(crossed[r]);
    }
  }
  void at_bit(unsigned bit, std::uint32_t ids[12]) const {
    const std::uint64_t below = (std::uint64_t{1} << bit) - 1;
    for (std::size_t r = 0; r < 4; ++r) {
      ids[r] = next[r] + ones(crossed[r] & below);
    }
    for (std::size_t r = 4; r < 8; ++r) {
      const std::uint32_t id = next[r] + ones(crossed[r] & below);
      ids[2 * r - 4] = id;
      ids[2 * r - 3] = id + static_cast<std::uint32_t>((crossed[r] >> bit) & 1U);
    }
  }
};

std::size_t emit_row(const CellLayer& layer, std::size_t j, bool flip, std::uint32_t* out) {
  const std::size_t n_words = layer.lower.words_per_row;
  const std::uint64_t* const rows[4] = {layer.lower.row(j), layer.lower.row(j + 1),
                                        layer.upper.row(j), layer.upper.row(j + 1)};
  CellIds cell{{layer.i_lower[j], layer.i_lower[j + 1], layer.i_upper[j], layer.i_upper[j + 1],
                layer.j_lower[j], layer.j_upper[j], layer.k[j], layer.k[j + 1]},
               {}};
  const std::size_t second = flip ? 2 : 1;
  const std::size_t third = flip ? 1 : 2;
  std::uint32_t* const first = out;
  for (std::size_t w = 0; w < n_words; ++w) {
    const CornerWords corners(rows, w, n_words);
    const std::uint64_t mask = cell_mask(layer.lower.n_samples, w);
    std::uint64_t active = corners.active() & mask;
    if (active == 0) {
      continue;  // then no crossed edge of a later cell starts here either
    }
    cell.set_words(corners, mask);
    for (; active != 0; active &= active - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(active));
      std::uint32_t ids[12];
      cell.at_bit(bit, ids);
      const CaseRow& row = kCases[corners.cell_case(bit)];
      for (std::size_t t = 0; t < row.n_triangles; ++t) {
        out[0] = ids[row.edges[3 * t]];
        out[1] = ids[row.edges[3 * t + second]];
        out[2] = ids[row.edges[3 * t + third]];
        out += 3;
      }
    }
    cell.pass_word();
  }
  return static_cast<std::size_t>(out - first);
}

std::size_t emit_triangles(const CellLayer& layer, std::size_t j0, std::size_t j1, bool flip,
                           std::uint32_t* out) {
  std::size_t n = 0;
  for (std::size_t j = j0; j < j1; ++j) {
    n += emit_row(layer, j, flip, out + n);
  }
  return n;
}

std::uint64_t count_triangles(const BitPlane& lower, const BitPlane& upper) {
  std::uint64_t n = 0;
  for (std::size_t j = 0; j + 1 < lower.n_rows; ++j) {
    const std::uint64_t* const rows[4] = {lower.row(j), lower.row(j + 1), upper.row(j),
                                          upper.row(j + 1)};
    for (std::size_t w = 0; w < lower.words_per_row; ++w) {
      const CornerWords corners(rows, w, lower.words_per_row);
      std::uint64_t active = corners.active() & cell_mask(lower.n_samples, w);
      for (; active != 0; active &= active - 1) {
        n += kCases[corners.cell_case(static_cast<unsigned>(std::countr_zero(active)))].n_triangles;
      }
    }
  }
  return n;
}

}  // namespace HWY_NAMESPACE
}  // namespace mc::extraction
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
