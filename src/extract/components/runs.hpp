// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "extract/bits/row_kernels.hpp"
#include "mc/extract.hpp"

// Runs of solid samples, and which of them are connected. Labels are kept by run, not by sample:
//
//   row 0   . # # # . . # #        runs 0 and 1
//   row 1   . . # . # # # .        runs 2 and 3: 2 joins 0; 3 joins 1
//
// Run-based labelling with union-find follows Rosenfeld and Pfaltz, "Sequential operations in
// digital picture processing", JACM 1966, and He, Chao and Suzuki, "A run-based two-scan labeling
// algorithm", IEEE TIP 2008. Differs: runs come from words of bits.

namespace mc::extraction {

/// Samples [first, last] of a row.
struct Run {
  std::int32_t first, last;
};

/// Calls f(first, last) for each solid run of row j: of ones, or of zeros if the solid is below.
template <class F>
void for_each_run(const BitPlane& plane, std::size_t j, Inside inside, F&& f) {
  const std::uint64_t* row = plane.row(j);
  std::int32_t first = 0;
  bool in_run = false;
  for (std::size_t w = 0; 64 * w < plane.n_samples; ++w) {
    const std::size_t left = plane.n_samples - 64 * w;
    const std::uint64_t exists = left >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << left) - 1;
    const std::uint64_t solid = (inside == Inside::above ? row[w] : ~row[w]) & exists;
    const std::uint64_t before = solid << 1 | static_cast<std::uint64_t>(in_run);
    for_each_bit(solid ^ before, [&](int bit) {
      const std::int32_t i = index_in_row(w, bit);
      if (in_run) {
        f(first, i - 1);
      } else {
        first = i;
      }
      in_run = !in_run;
    });
  }
  if (in_run) f(first, static_cast<std::int32_t>(plane.n_samples) - 1);
}

/// The solid runs of one plane, row by row.
struct PlaneRuns {
  std::vector<Run> runs;
  std::vector<std::uint32_t> row_start;  ///< of each row, and the number of all

  [[nodiscard]] std::span<const Run> row(std::size_t j) const {
    return std::span(runs).subspan(row_start[j], row_start[j + 1] - row_start[j]);
  }
  void list(const BitPlane& plane, Inside inside) {
    runs.clear();
    row_start.clear();
    for (std::size_t j = 0; j < plane.n_rows; ++j) {
      row_start.push_back(static_cast<std::uint32_t>(runs.size()));
      for_each_run(plane, j, inside, [this](std::int32_t first, std::int32_t last) {
        runs.push_back({first, last});
      });
    }
    row_start.push_back(static_cast<std::uint32_t>(runs.size()));
  }
};

/// Calls f(a, b) for each run n of row `a` and m of row `b` that touch: their samples lie side by
/// side, or at most `reach` samples further along the row.
template <class F>
void for_each_touching(std::span<const Run> a, std::span<const Run> b, std::int32_t reach, F&& f) {
  std::size_t n = 0, m = 0;
  while (n < a.size() && m < b.size()) {
    if (a[n].first <= b[m].last + reach && b[m].first <= a[n].last + reach) f(n, m);
    if (a[n].last < b[m].last) {
      ++n;
    } else {
      ++m;
    }
  }
}

}  // namespace mc::extraction
