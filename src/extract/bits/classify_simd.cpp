// SPDX-License-Identifier: MIT
#include "extract/bits/classify.hpp"

// Compiles classify-inl.hpp for every target that Highway offers and picks one at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "extract/bits/classify_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "extract/bits/classify-inl.hpp"

#if HWY_ONCE
#include <cassert>

namespace mc::extraction {

namespace {
HWY_EXPORT(classify_rows);
}  // namespace

void classify_rows(const Threshold& threshold, const SampleRows& rows, std::uint64_t* words,
                   std::size_t words_per_row) {
  assert(words_per_row >= (rows.n_samples + 63) / 64);
  assert(rows.n_rows == 0 || (rows.first != nullptr && words != nullptr));
  HWY_DYNAMIC_DISPATCH(classify_rows)(threshold, rows, words, words_per_row);
}

}  // namespace mc::extraction
#endif  // HWY_ONCE
