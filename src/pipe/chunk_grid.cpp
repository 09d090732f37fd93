// SPDX-License-Identifier: MIT
#include "pipe/chunk_grid.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

#include "field/block.hpp"

namespace mc::pipe {

ChunkGrid::ChunkGrid(const IndexBox& region, bool capped, std::int32_t n_cells, std::int32_t ring)
    : region_(region),
      pad_(capped ? 1 : 0),
      ring_(ring),
      shift_(std::countr_zero(static_cast<std::uint32_t>(n_cells))) {
  assert(std::has_single_bit(static_cast<std::uint32_t>(n_cells)));
  for (std::size_t a = 0; a < 3; ++a) {
    if (region.hi[a] - region.lo[a] + 2 * pad_ < 1) return;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    chunks_.lo[a] = region.lo[a] >> shift_;
    chunks_.hi[a] = std::max(region.lo[a], region.hi[a] - 1) >> shift_;
  }
}

IndexBox ChunkGrid::part(const Index3& id) const {
  IndexBox part;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int32_t first = id[a] * (1 << shift_);
    part.lo[a] = id[a] == chunks_.lo[a] ? region_.lo[a] - pad_ : first;
    part.hi[a] = id[a] == chunks_.hi[a] ? region_.hi[a] + pad_ : first + (1 << shift_);
  }
  return part;
}

Index3 ChunkGrid::chunk_of(const Index3& cell) const {
  Index3 id;
  for (std::size_t a = 0; a < 3; ++a) {
    id[a] = std::clamp(cell[a] >> shift_, chunks_.lo[a], chunks_.hi[a]);
  }
  return id;
}

IndexBox ChunkGrid::reached(const IndexBox& samples) const {
  IndexBox cells;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int32_t lo = std::max(samples.lo[a], region_.lo[a]);
    const std::int32_t hi = std::min(samples.hi[a], region_.hi[a]);
    if (lo > hi || is_empty(chunks_)) return {};
    cells.lo[a] = lo - 1 - ring_;
    cells.hi[a] = hi + ring_;
  }
  return {chunk_of(cells.lo), chunk_of(cells.hi)};
}

std::uint64_t count_of(const IndexBox& box) {
  if (is_empty(box)) return 0;
  constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max();
  const auto extent = [&](int axis) { return static_cast<std::uint64_t>(box.extent(axis)); };
  const std::uint64_t row_and_plane = extent(0) * extent(1);
  return row_and_plane > kMost / extent(2) ? kMost : row_and_plane * extent(2);
}

void append_all(const IndexBox& box, std::vector<Index3>& out) {
  for (std::int32_t z = box.lo[2]; z <= box.hi[2]; ++z) {
    for (std::int32_t y = box.lo[1]; y <= box.hi[1]; ++y) {
      for (std::int32_t x = box.lo[0]; x <= box.hi[0]; ++x) out.push_back({x, y, z});
    }
  }
}

void sort_unique(std::vector<Index3>& ids) {
  std::ranges::sort(ids, field::comes_before);
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

}  // namespace mc::pipe
