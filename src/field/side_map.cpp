// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>

#include "mc/field.hpp"

// What readers leave out, in rows of bits as the engine wants them.

namespace mc {

namespace {

std::size_t blocks(std::int64_t extent, std::int32_t size) {
  return static_cast<std::size_t>((extent + size - 1) / size);
}

/// Sets bits [first, last) of a row.
void set_bits(std::uint64_t* row, std::size_t first, std::size_t last) {
  for (std::size_t at = first; at < last;) {
    const std::size_t n = std::min(last - at, 64 - at % 64);
    row[at / 64] |= (~std::uint64_t{0} >> (64 - n)) << (at % 64);
    at += n;
  }
}

}  // namespace

void SideMap::reset(const IndexBox& box, std::int32_t rows, std::int32_t planes) {
  box_ = box;
  rows_ = rows;
  planes_ = planes;
  n_left_out_ = 0;
  n_row_blocks_ = blocks(box.extent(1), rows);
  n_words_ = blocks(box.extent(0), 64);
  const std::size_t n_rows = n_row_blocks_ * blocks(box.extent(2), planes);
  known_.assign(n_rows * n_words_, 0);
  above_.assign(n_rows * n_words_, 0);
  for (std::size_t r = 0; r < n_rows; ++r) {
    set_bits(known_.data() + r * n_words_, static_cast<std::size_t>(box.extent(0)), 64 * n_words_);
  }
}

void SideMap::leave_out(const IndexBox& part, bool above) {
  assert(box_.contains(part) && (part.lo[1] - box_.lo[1]) % rows_ == 0);
  const auto first = static_cast<std::size_t>(part.lo[0] - box_.lo[0]);
  const auto last = static_cast<std::size_t>(part.hi[0] - box_.lo[0]) + 1;
  for (std::int32_t j = part.lo[1]; j <= part.hi[1]; j += rows_) {
    const std::size_t at = row(j, part.lo[2]);
    set_bits(known_.data() + at, first, last);
    if (above) set_bits(above_.data() + at, first, last);
  }
  n_left_out_ +=
      static_cast<std::uint64_t>(part.extent(0) * part.extent(1)) * std::uint64_t(part.extent(2));
}

std::size_t SideMap::row(std::int32_t j, std::int32_t k) const {
  assert(j >= box_.lo[1] && j <= box_.hi[1] && k >= box_.lo[2] && k <= box_.hi[2]);
  const auto row_block = static_cast<std::size_t>((j - box_.lo[1]) / rows_);
  const auto plane_block = static_cast<std::size_t>((k - box_.lo[2]) / planes_);
  return (plane_block * n_row_blocks_ + row_block) * n_words_;
}

}  // namespace mc
