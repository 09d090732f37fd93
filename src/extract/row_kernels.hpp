// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "extract/threshold.hpp"

// The kernels of the engine that are compiled for every SIMD target and chosen at run time: one bit
// a sample from a plane of samples, and word arithmetic on those bits: counts, ids, triangles. A
// call handles a plane or a layer, so that the choice costs nothing.

namespace mc::extraction {

/// Rows of samples in memory.
struct SampleRows {
  const std::byte* first = nullptr;
  std::size_t stride_bytes = 0;
  std::size_t n_samples = 0;  ///< in a row
  std::size_t n_rows = 0;
};

/// Sets bit i of row r (words + r * words_per_row) where sample (i, r) is above; bits past the
/// row's end are zero. words_per_row >= ceil(n_samples / 64).
void classify_rows(const Threshold& threshold, const SampleRows& rows, std::uint64_t* words,
                   std::size_t words_per_row);

/// A plane of sample bits. Bits past n_samples are zero.
struct BitPlane {
  const std::uint64_t* words = nullptr;
  std::size_t words_per_row = 0;
  std::size_t n_samples = 0;
  std::size_t n_rows = 0;

  [[nodiscard]] const std::uint64_t* row(std::size_t j) const { return words + j * words_per_row; }
};

/// Writes the id of the first i-vertex and the first j-vertex of each row, counting from `next`;
/// row by row, i before j. Returns the id after the last.
std::uint32_t number_plane(const BitPlane& plane, std::uint32_t next, std::uint32_t* i_start,
                           std::uint32_t* j_start);
/// The same for the k-vertices between two planes.
std::uint32_t number_between(const BitPlane& lower, const BitPlane& upper, std::uint32_t next,
                             std::uint32_t* k_start);

/// One layer of cells: the planes below and above it, and the first ids of their rows.
struct CellLayer {
  BitPlane lower, upper;
  const std::uint32_t *i_lower = nullptr, *j_lower = nullptr;
  const std::uint32_t *i_upper = nullptr, *j_upper = nullptr;
  const std::uint32_t* k = nullptr;
};

/// Writes the triangles of cell rows [j0, j1) as vertex ids, three each, in cell order. `flip`
/// turns them round. Room for 15 ids a cell is needed. Returns the number of ids written.
std::size_t emit_triangles(const CellLayer& layer, std::size_t j0, std::size_t j1, bool flip,
                           std::uint32_t* out);
/// How many triangles the layer has.
std::uint64_t count_triangles(const BitPlane& lower, const BitPlane& upper);

}  // namespace mc::extraction
