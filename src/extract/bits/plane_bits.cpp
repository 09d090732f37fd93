// SPDX-License-Identifier: MIT
#include "extract/bits/plane_bits.hpp"

#include <algorithm>
#include <cassert>

namespace mc::extraction {

namespace {
/// Half of a small second cache: what was read last is still there when its vertices are made.
constexpr std::size_t kBandBytes = 1U << 18U;
constexpr std::size_t kMinBandRows = 64;
}  // namespace

PlaneClassifier::PlaneClassifier(const Volume& volume, const ExtractOptions& options,
                                 const std::optional<IndexBox>& part)
    : threshold_(volume.type, volume.endian, options.iso, options.inside),
      region_(options.region.value_or(volume.lattice.box)),
      pad_(options.border != Border::open ? 1 : 0),
      ring_(options.normals != Normals::none ? 1 : 0),
      above_outside_((options.border == Border::solid) == (options.inside == Inside::above)) {
  set_part(part.value_or(whole()));
}

IndexBox PlaneClassifier::whole() const { return grown(region_, pad_); }

void PlaneClassifier::set_part(const IndexBox& part) {
  assert(whole().contains(part) && !is_empty(part));
  part_ = part;
  known_ = common_part(part, region_);
  box_ = common_part(grown(part, ring_), region_);
  row_samples_ = static_cast<std::size_t>(part.extent(0));
  n_rows_ = static_cast<std::size_t>(part.extent(1));
  n_words_ = padded_words(row_samples_);
  cells_.clear();
  for (std::size_t w = 0; w < n_words_; ++w) {
    cells_.push_back(cell_mask(row_samples_, w));
  }
  column_cells_.clear();
  for (std::size_t w = 0; 64 * w < n_rows_; ++w) {
    column_cells_.push_back(cell_mask(n_rows_, w));
  }
}

void PlaneClassifier::shape(PlaneBits& plane) const {
  plane.words.assign(n_words_ * n_rows_ + 1, 0);
  plane.first_column.resize(column_cells_.size() + 1);
  plane.last_column.resize(column_cells_.size() + 1);
  plane.i_start.resize(n_rows_);
  plane.j_start.resize(n_rows_);
}

std::size_t PlaneClassifier::rows_at_once() const {
  return std::max(kMinBandRows, kBandBytes / (row_samples_ * sample_size(threshold_.type)));
}

void PlaneClassifier::fill_row(std::uint64_t* row) const {
  const std::uint64_t constant = above_outside_ ? ~std::uint64_t{0} : 0;
  std::fill_n(row, row_samples_ / 64, constant);
  if (row_samples_ % 64 != 0) {
    row[row_samples_ / 64] = constant & ((std::uint64_t{1} << (row_samples_ % 64)) - 1);
  }
}

/// Puts the constant layer at those ends of a row where the part reaches into it.
void PlaneClassifier::pad_row(std::uint64_t* row) const {
  const bool at_first = part_.lo[0] < known_.lo[0];
  const bool at_last = part_.hi[0] > known_.hi[0];
  if (at_first) {
    for (std::size_t w = (row_samples_ + 63) / 64; w-- > 0;) {
      row[w] = (row[w] << 1) | (w > 0 ? row[w - 1] >> 63 : 0);
    }
    row[0] |= above_outside_ ? 1 : 0;
  }
  if (at_last && above_outside_) {
    const std::size_t last = row_samples_ - 1;
    row[last / 64] |= std::uint64_t{1} << (last % 64);
  }
}

SampleRows PlaneClassifier::rows_of(const Slab& slab, std::int32_t j, std::int32_t k,
                                    std::size_t n_rows) const {
  assert(slab.k0 <= k && static_cast<std::size_t>(k - slab.k0) < slab.planes.size());
  assert(slab.j0 <= j && slab.i0 <= known_.lo[0]);
  const std::byte* first =
      slab.planes[static_cast<std::size_t>(k - slab.k0)] +
      static_cast<std::size_t>(j - slab.j0) * slab.row_stride_bytes +
      static_cast<std::size_t>(known_.lo[0] - slab.i0) * sample_size(threshold_.type);
  return {first, slab.row_stride_bytes, static_cast<std::size_t>(known_.extent(0)), n_rows};
}

/// Classifies rows from j on, all in one block of the slab's map: words of which it does not know
/// all samples, then puts in what it knows.
void PlaneClassifier::classify_block(const Slab& slab, std::int32_t j, std::int32_t k,
                                     std::size_t n_rows, std::uint64_t* words) const {
  const auto known = slab.sides.known(j, k);
  const auto above = slab.sides.above(j, k);
  const SampleRows rows = rows_of(slab, j, k, n_rows);
  const auto has_samples = [](std::uint64_t word) { return word != ~std::uint64_t{0}; };
  auto end = known.begin();
  for (;;) {
    const auto begin = std::find_if(end, known.end(), has_samples);
    if (begin == known.end()) break;
    end = std::find_if_not(begin, known.end(), has_samples);
    const auto w = static_cast<std::size_t>(begin - known.begin());
    const auto w_end = static_cast<std::size_t>(end - known.begin());
    SampleRows part = rows;
    part.first += 64 * w * sample_size(threshold_.type);
    part.n_samples = std::min(64 * w_end, rows.n_samples) - 64 * w;
    classify_rows(threshold_, part, words + w, n_words_);
  }
  for (std::size_t r = 0; r < n_rows; ++r) {
    std::uint64_t* row = words + r * n_words_;
    for (std::size_t w = 0; w < known.size(); ++w) row[w] = (row[w] & ~known[w]) | above[w];
  }
}

/// Classifies rows of samples from j on.
void PlaneClassifier::classify_samples(const Slab& slab, std::int32_t j, std::int32_t k,
                                       std::size_t n_rows, std::uint64_t* words) const {
  if (slab.sides.empty()) {
    return classify_rows(threshold_, rows_of(slab, j, k, n_rows), words, n_words_);
  }
  assert(known_.lo[0] == slab.sides.box().lo[0]);
  const std::int32_t block = slab.sides.rows();
  for (const std::int32_t end = j + static_cast<std::int32_t>(n_rows); j < end;) {
    const std::int32_t n = std::min(end - j, block - (j - slab.sides.box().lo[1]) % block);
    classify_block(slab, j, k, static_cast<std::size_t>(n), words);
    words += static_cast<std::size_t>(n) * n_words_;
    j += n;
  }
}

void PlaneClassifier::classify(const Slab& slab, std::int32_t plane, std::size_t j0, std::size_t j1,
                               PlaneBits& out) const {
  assert(0 <= plane && plane < n_planes());
  assert(j0 <= j1 && j1 <= n_rows_);
  assert(out.words.size() == n_words_ * n_rows_ + 1);  // shape() came first
  const auto row = [&](std::size_t j) { return out.words.data() + j * n_words_; };
  const auto n_before = static_cast<std::size_t>(known_.lo[1] - part_.lo[1]);
  const auto n_behind = static_cast<std::size_t>(part_.hi[1] - known_.hi[1]);
  const std::int32_t k = first_of(plane)[2];
  const bool is_constant = k < known_.lo[2] || k > known_.hi[2];
  const std::size_t first = is_constant ? j1 : std::max(j0, n_before);
  const std::size_t last = is_constant ? j1 : std::min(j1, n_rows_ - n_behind);
  for (std::size_t j = j0; j < first; ++j) {
    fill_row(row(j));
  }
  if (first < last) {
    const auto n_samples = static_cast<std::size_t>(known_.extent(0));
    const std::int32_t j = part_.lo[1] + static_cast<std::int32_t>(first);
    classify_samples(slab, j, k, last - first, row(first));
    for (std::size_t r = first; r < last && capped(); ++r) {
      std::fill(row(r) + (n_samples + 63) / 64, row(r) + n_words_, 0);
      pad_row(row(r));
    }
  }
  for (std::size_t j = last; j < j1; ++j) {
    fill_row(row(j));
  }
}

void PlaneClassifier::take_columns(PlaneBits& plane) const {
  assert(plane.words.size() == n_words_ * n_rows_ + 1);
  assert(plane.first_column.size() > (n_rows_ - 1) / 64);
  const std::size_t last = row_samples_ - 1;
  for (std::size_t w = 0; 64 * w < n_rows_; ++w) {
    std::uint64_t first_word = 0;
    std::uint64_t last_word = 0;
    const std::size_t end = std::min<std::size_t>(64, n_rows_ - 64 * w);
    for (std::size_t b = 0; b < end; ++b) {
      const std::uint64_t* row = plane.words.data() + (64 * w + b) * n_words_;
      first_word |= (row[0] & 1U) << b;
      last_word |= (row[last / 64] >> (last % 64) & 1U) << b;
    }
    plane.first_column[w] = first_word;
    plane.last_column[w] = last_word;
  }
}

std::uint64_t PlaneClassifier::plane_sides(const PlaneBits& plane) const {
  const BitPlane bits = view(plane);
  std::uint64_t n = 0;
  for (std::size_t j = 0; j + 1 < n_rows_; ++j) {
    n += count_face_sides(bits.row(j), bits.row(j + 1), cells_.data(), (row_samples_ + 63) / 64);
  }
  return n;
}

std::uint64_t PlaneClassifier::border_sides(const PlaneBits& lower, const PlaneBits& upper,
                                            bool is_first, bool is_last) const {
  if (capped() && part_ == whole()) {
    return 0;
  }
  const auto sides = [](const std::uint64_t* a, const std::uint64_t* b, const auto& cells,
                        std::size_t n_samples) {
    return count_face_sides(a, b, cells.data(), (n_samples + 63) / 64);
  };
  std::uint64_t n =
      sides(lower.first_column.data(), upper.first_column.data(), column_cells_, n_rows_) +
      sides(lower.last_column.data(), upper.last_column.data(), column_cells_, n_rows_);
  for (const std::size_t j : {std::size_t{0}, n_rows_ - 1}) {
    n += sides(view(lower).row(j), view(upper).row(j), cells_, row_samples_);
  }
  return n + (is_first ? plane_sides(lower) : 0) + (is_last ? plane_sides(upper) : 0);
}

}  // namespace mc::extraction
