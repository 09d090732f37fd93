// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see row_kernels.hpp for what the functions do.

#if defined(MC_EXTRACT_BITS_ROW_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_EXTRACT_BITS_ROW_KERNELS_INL
#undef MC_EXTRACT_BITS_ROW_KERNELS_INL
#else
#define MC_EXTRACT_BITS_ROW_KERNELS_INL
#endif

#include <hwy/highway.h>

#include "extract/bits/row_kernels.hpp"
#include "extract/bits/row_words-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::extraction::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

std::uint32_t number_plane(const BitPlane& plane, std::uint32_t next, const PlaneIds& ids) {
  for (std::size_t j = 0; j < plane.n_rows; ++j) {
    ids.i[j] = next;
    next += count_row(AlongRow{plane.row(j), plane.cells}, plane.words_in_use());
    ids.j[j] = next;
    if (j + 1 < plane.n_rows) {
      next += count_row(BetweenRows{plane.row(j), plane.row(j + 1)}, plane.words_in_use());
    }
  }
  return next;
}

std::uint32_t number_between(const BitPlane& lower, const BitPlane& upper, std::uint32_t next,
                             std::uint32_t* k_ids) {
  for (std::size_t j = 0; j < lower.n_rows; ++j) {
    k_ids[j] = next;
    next += count_row(BetweenRows{lower.row(j), upper.row(j)}, lower.words_in_use());
  }
  return next;
}

/// Appends the edges of rows to a list. Four are written at once whatever their number is: most
/// words have fewer, and a loop would be mispredicted at every end.
class EdgeLister {
 public:
  explicit EdgeLister(EdgeList& list) : list_(list) {}

  template <class Source>
  HWY_INLINE void row(const Source& source, std::size_t n_words, std::size_t j, std::int32_t axis) {
    const hn::CappedTag<std::int32_t, kAtOnce> d;
    const auto all_j = hn::Set(d, list_.first[1] + static_cast<std::int32_t>(j));
    const auto all_axis = hn::Set(d, axis);
    for_each_word(source, n_words, [&](std::size_t w, std::uint64_t word) {
      const std::int32_t base = list_.first[0] + static_cast<std::int32_t>(w * 64);
      std::size_t at = n_;
      n_ += ones(word);
      do {
        for (std::size_t n = 0; n < kAtOnce; n += hn::Lanes(d)) {
          hn::StoreU(all_j, d, list_.j + at + n);
          hn::StoreU(all_axis, d, list_.axis + at + n);
        }
        for (std::size_t n = 0; n < kAtOnce; ++n) {
          list_.i[at++] = base + std::countr_zero(word);
          word &= word - 1;
        }
      } while (word != 0);
    });
  }
  [[nodiscard]] std::uint32_t n() const { return static_cast<std::uint32_t>(n_); }
  [[nodiscard]] bool has_room(std::size_t for_a_row) const { return n_ + for_a_row <= list_.room; }

 private:
  static constexpr std::size_t kAtOnce = 4;

  const EdgeList list_;  // a copy, so that what is written cannot alias it
  std::size_t n_ = 0;
};

std::size_t list_plane(const BitPlane& plane, std::size_t j, std::size_t j_end, std::uint32_t& next,
                       const PlaneIds& ids, EdgeList& list) {
  EdgeLister lister(list);
  for (; j < j_end && lister.has_room(list_room(plane.n_samples)); ++j) {
    ids.i[j] = next + lister.n();
    lister.row(AlongRow{plane.row(j), plane.cells}, plane.words_in_use(), j, 0);
    ids.j[j] = next + lister.n();
    if (j + 1 < plane.n_rows) {
      lister.row(BetweenRows{plane.row(j), plane.row(j + 1)}, plane.words_in_use(), j, 1);
    }
  }
  list.n = lister.n();
  next += lister.n();
  return j;
}

std::size_t list_between(const BitPlane& lower, const BitPlane& upper, std::size_t j,
                         std::size_t j_end, std::uint32_t& next, std::uint32_t* k_ids,
                         EdgeList& list) {
  EdgeLister lister(list);
  for (; j < j_end && lister.has_room(list_room(lower.n_samples)); ++j) {
    k_ids[j] = next + lister.n();
    lister.row(BetweenRows{lower.row(j), upper.row(j)}, lower.words_in_use(), j, 2);
  }
  list.n = lister.n();
  next += lister.n();
  return j;
}

std::uint64_t count_face_sides(const std::uint64_t* a, const std::uint64_t* b,
                               const std::uint64_t* cells, std::size_t n_words) {
  std::uint64_t n = 0;
  const auto next = [](const std::uint64_t* row, std::size_t w) {
    return (row[w] >> 1) | (row[w + 1] << 63);
  };
  for (std::size_t w = 0; w < n_words; ++w) {
    const std::uint64_t crossed = a[w] ^ b[w];
    const std::uint64_t crossed_next = next(a, w) ^ next(b, w);
    n += ones((a[w] ^ next(a, w)) & cells[w]) + ones((b[w] ^ next(b, w)) & cells[w]) +
         ones(crossed & cells[w]) + ones(crossed_next & cells[w]);
  }
  return n / 2;
}

}  // namespace mc::extraction::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
