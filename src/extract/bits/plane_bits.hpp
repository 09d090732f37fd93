// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "extract/bits/classify.hpp"
#include "extract/bits/row_kernels.hpp"
#include "extract/bits/threshold.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"

// Planes of sample bits of a dense volume or a region of it, with the constant layer of a closed
// border around it where there is one: bits, never a copy of the data. All of it, or a part.

namespace mc::extraction {

/// Bits of one plane and what follows from them.
struct PlaneBits {
  Buffer<std::uint64_t> words;
  std::vector<std::uint64_t> first_column, last_column;  ///< the rows' ends, as rows
  std::vector<std::uint32_t> i_start, j_start;           ///< first ids of the rows

  [[nodiscard]] PlaneIds ids() { return {i_start.data(), j_start.data()}; }
  [[nodiscard]] RowIds row_ids() const { return {i_start.data(), j_start.data()}; }
};

/// The shape of planes, and how they are made.
class PlaneClassifier {
 public:
  /// Starts with a part, or with all.
  PlaneClassifier(const Volume& volume, const ExtractOptions& options,
                  const std::optional<IndexBox>& part = {});

  /// The region and, where the border is closed, the layer around it.
  [[nodiscard]] IndexBox whole() const;
  /// Makes planes of these samples of whole() only, until told otherwise.
  void set_part(const IndexBox& part);

  [[nodiscard]] const Threshold& threshold() const { return threshold_; }
  /// Samples that the surface is made of: of the region, those that normals look at too.
  [[nodiscard]] const IndexBox& box() const { return box_; }
  [[nodiscard]] bool capped() const { return pad_ != 0; }
  /// Lattice indices of a plane's first sample, which may lie in the constant layer.
  [[nodiscard]] Index3 first_of(std::int32_t plane) const {
    return {part_.lo[0], part_.lo[1], part_.lo[2] + plane};
  }
  [[nodiscard]] std::size_t row_samples() const { return row_samples_; }
  [[nodiscard]] std::size_t n_rows() const { return n_rows_; }
  [[nodiscard]] std::int64_t n_planes() const { return part_.extent(2); }
  [[nodiscard]] std::uint64_t plane_bytes() const {
    return (n_words_ * n_rows_ + 1) * sizeof(std::uint64_t);
  }

  /// Gives a plane the shape of this part, and no bits.
  void shape(PlaneBits& plane) const;
  [[nodiscard]] BitPlane view(const PlaneBits& plane) const {
    return {plane.words.data(), cells_.data(), n_words_, row_samples_, n_rows_};
  }
  /// Rows that are worth reading in several streams and yet stay in a core's cache.
  [[nodiscard]] std::size_t rows_at_once() const;

  /// Makes rows [j0, j1) of a plane. The slab holds it, unless it is of the constant layer.
  void classify(const Slab& slab, std::int32_t plane, std::size_t j0, std::size_t j1,
                PlaneBits& out) const;
  /// Makes the columns of a plane from its bits.
  void take_columns(PlaneBits& plane) const;

  /// Sides of triangles in those of the part's faces that a layer of cells touches; none where the
  /// border is closed.
  [[nodiscard]] std::uint64_t border_sides(const PlaneBits& lower, const PlaneBits& upper,
                                           bool is_first, bool is_last) const;

 private:
  void fill_row(std::uint64_t* row) const;
  [[nodiscard]] SampleRows rows_of(const Slab& slab, std::int32_t j, std::int32_t k,
                                   std::size_t n_rows) const;
  void classify_block(const Slab& slab, std::int32_t j, std::int32_t k, std::size_t n_rows,
                      std::uint64_t* words) const;
  void classify_samples(const Slab& slab, std::int32_t j, std::int32_t k, std::size_t n_rows,
                        std::uint64_t* words) const;
  void pad_row(std::uint64_t* row) const;
  [[nodiscard]] std::uint64_t plane_sides(const PlaneBits& plane) const;

  Threshold threshold_;
  IndexBox region_;
  std::int32_t pad_, ring_;
  bool above_outside_;  ///< what the constant layer is
  IndexBox part_, box_;
  IndexBox known_;  ///< samples of the part that are not of the constant layer
  std::size_t row_samples_ = 0, n_rows_ = 0, n_words_ = 0;
  Buffer<std::uint64_t> cells_;              ///< ones for the cells of a row
  std::vector<std::uint64_t> column_cells_;  ///< and of a column
};

}  // namespace mc::extraction
