// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "extract/bits/bit_row.hpp"
#include "extract/bits/cell.hpp"
#include "mc/base.hpp"

// Word arithmetic on sample bits: which edges are crossed, and the ids of their vertices.
// Compiled for every SIMD target and chosen at run time. A call handles many rows, so that the
// choice costs nothing.

namespace mc::extraction {

/// A plane of sample bits in padded rows: bits past n_samples are zero.
struct BitPlane {
  const std::uint64_t* words = nullptr;
  const std::uint64_t* cells = nullptr;  ///< one row: ones for the cells, or i-edges
  std::size_t words_per_row = 0;         ///< a multiple of kWordsAtOnce; one more can be read
  std::size_t n_samples = 0;
  std::size_t n_rows = 0;

  [[nodiscard]] const std::uint64_t* row(std::size_t j) const { return words + j * words_per_row; }
  /// Words of a row worth looking at: one, where that is all, else whole vectors.
  [[nodiscard]] std::size_t words_in_use() const { return n_samples <= 64 ? 1 : words_per_row; }
};

/// The corners of 64 cells: words w of the rows j and j + 1 of two planes, and of the samples
/// after.
class CellWords {
 public:
  CellWords(const BitPlane& lower, const BitPlane& upper, std::size_t j, std::size_t w) {
    for (std::size_t n = 0; n < 4; ++n) {
      const std::uint64_t* row = (n < 2 ? lower : upper).row(j + n % 2);
      corners_[2 * n] = row[w];
      corners_[2 * n + 1] = next_samples(row, w, lower.words_per_row);
    }
  }
  /// Ones for cells whose corners differ.
  [[nodiscard]] std::uint64_t active() const {
    std::uint64_t any = 0;
    std::uint64_t all = ~std::uint64_t{0};
    for (const std::uint64_t corner : corners_) {
      any |= corner;
      all &= corner;
    }
    return any & ~all;
  }
  [[nodiscard]] CellCase case_at(int bit) const {
    std::size_t bits = 0;
    for (std::size_t c = 0; c < kCorners; ++c) bits |= (corners_[c] >> bit & 1U) << c;
    return CellCase(bits);
  }

 private:
  std::array<std::uint64_t, kCorners> corners_{};
};

/// Whether rows are padded as the kernels need them, and there is a row of cells.
[[nodiscard]] inline bool is_padded(const BitPlane& plane) {
  return plane.words != nullptr && plane.cells != nullptr && plane.n_rows >= 1 &&
         plane.n_samples >= 1 && plane.words_per_row == padded_words(plane.n_samples);
}
/// Whether two planes have rows of the same shape, and share the row of cells.
[[nodiscard]] inline bool same_shape(const BitPlane& a, const BitPlane& b) {
  return is_padded(a) && is_padded(b) && a.n_samples == b.n_samples && a.n_rows == b.n_rows;
}

/// Ids that follow from the number of crossed edges: of the first i- and the first j-vertex of each
/// row, or of the first k-vertex of each row.
struct PlaneIds {
  std::uint32_t* i = nullptr;
  std::uint32_t* j = nullptr;
};

/// The same to read.
struct RowIds {
  const std::uint32_t* i = nullptr;
  const std::uint32_t* j = nullptr;
};

/// Writes the ids of a plane's rows, counting from `next`; row by row, i before j. Returns the id
/// after the last.
std::uint32_t number_plane(const BitPlane& plane, std::uint32_t next, const PlaneIds& ids);
/// The same for the k-vertices between two planes.
std::uint32_t number_between(const BitPlane& lower, const BitPlane& upper, std::uint32_t next,
                             std::uint32_t* k_ids);

/// Crossed edges of some rows in the order of their vertices: lattice indices of the lower sample,
/// and the axis along which the edge runs.
struct EdgeList {
  Index3 first{};  ///< indices of the plane's first sample
  std::int32_t *i = nullptr, *j = nullptr, *axis = nullptr;
  std::size_t room = 0;  ///< at least list_room(); more makes calls rarer
  std::size_t n = 0;
};
/// Room that listing needs: two edges a sample of one row, and what is written past the end.
constexpr std::size_t list_room(std::size_t row_samples) { return 2 * row_samples + 8; }

/// Numbers and lists i- and j-edges of rows [j, j_end) while there is room for one more row; `next`
/// is the first id and becomes the id after the last. Returns the row after the last.
std::size_t list_plane(const BitPlane& plane, std::size_t j, std::size_t j_end, std::uint32_t& next,
                       const PlaneIds& ids, EdgeList& out);
/// The same for the k-edges between two planes.
std::size_t list_between(const BitPlane& lower, const BitPlane& upper, std::size_t j,
                         std::size_t j_end, std::uint32_t& next, std::uint32_t* k_ids,
                         EdgeList& out);

/// Sides of triangles in the faces of cells between two rows of samples: a face has two or four
/// crossed edges, or none, and half as many sides. One word past the rows can be read.
std::uint64_t count_face_sides(const std::uint64_t* a, const std::uint64_t* b,
                               const std::uint64_t* cells, std::size_t n_words);

}  // namespace mc::extraction
