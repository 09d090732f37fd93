// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "extract/bits/threshold.hpp"

// One bit a sample from a plane of samples: the only pass that reads every scalar, so it runs at
// the speed of memory. Compiled for every SIMD target and chosen at run time; a call handles a
// plane, so that the choice costs nothing.

namespace mc::extraction {

/// Rows of samples in memory.
struct SampleRows {
  const std::byte* first = nullptr;
  std::size_t stride_bytes = 0;
  std::size_t n_samples = 0;  ///< in a row
  std::size_t n_rows = 0;
};

/// Sets bit i of row r (words + r * words_per_row) where sample (i, r) is above; bits past the
/// row's end, in its last word, are zero. words_per_row >= ceil(n_samples / 64); words past that
/// are left alone.
void classify_rows(const Threshold& threshold, const SampleRows& rows, std::uint64_t* words,
                   std::size_t words_per_row);

}  // namespace mc::extraction
