// SPDX-License-Identifier: MIT
#include "extract/sparse/solid_cells.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>

#include "base/disjoint_sets.hpp"
#include "extract/bits/bit_row.hpp"

namespace mc::extraction {

using field::bit_index;
using field::BitIndex;
using field::Mask512;

namespace {

constexpr std::uint64_t kColumn7 = kColumn0 << 7;

/// Ones for places (x, y) for which (x + dx, y + dy) is one, within the plane.
std::uint64_t moved(std::uint64_t plane, std::int32_t dx, std::int32_t dy) {
  if (dx > 0) plane = (plane & ~kColumn0) >> 1;
  if (dx < 0) plane = (plane & ~kColumn7) << 1;
  return dy > 0 ? plane >> 8 : dy < 0 ? plane << 8 : plane;
}

/// Ones for places from which a step (dx, dy) leaves the plane.
std::uint64_t leaving(std::int32_t dx, std::int32_t dy) {
  std::uint64_t out = 0;
  if (dx != 0) out |= dx > 0 ? kColumn7 : kColumn0;
  if (dy != 0) out |= dy > 0 ? std::uint64_t{0xFF} << 56 : 0xFF;
  return out;
}

/// Towards the half of the neighbours that come later in (z, y, x) order, then all others.
std::vector<Index3> directions_of(Inside inside) {
  const int reach = inside == Inside::above ? 1 : 2;  // axes that a step may move along: 6, or 18
  std::vector<Index3> later;
  for (std::int32_t n = 14; n < 27; ++n) {
    const Index3 d{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
    if (std::abs(d[0]) + std::abs(d[1]) + std::abs(d[2]) <= reach) later.push_back(d);
  }
  const std::size_t n = later.size();
  for (std::size_t d = 0; d < n; ++d) {
    later.push_back({-later[d][0], -later[d][1], -later[d][2]});
  }
  return later;
}

/// The 26 cells around one, looked up when they are first asked for.
class CellsAround {
 public:
  struct Cell {
    bool known = false;
    std::size_t listed = kNoBlock;
    std::uint32_t whole = CellJoiner::kNone;  ///< if it is not listed
  };

  CellsAround(const SolidCells& cells, std::size_t n, const CellJoiner::Whole& whole)
      : cells_(cells), at_(cells.at[n]), whole_(whole) {}
  const Cell& at(const Index3& step) {
    Cell& cell = around_[static_cast<std::size_t>(13 + step[0] + 3 * step[1] + 9 * step[2])];
    if (!cell.known) {
      const Index3 at = sum_of(at_, step);
      cell = {true, cells_.find(at), CellJoiner::kNone};
      if (cell.listed == kNoBlock) cell.whole = whole_(at);
    }
    return cell;
  }

 private:
  const SolidCells& cells_;
  Index3 at_;
  const CellJoiner::Whole& whole_;
  std::array<Cell, 27> around_{};
};

}  // namespace

std::size_t SolidCells::find(const Index3& cell) const {
  const auto found = std::lower_bound(at.begin(), at.end(), cell, comes_before);
  const bool there = found != at.end() && same(*found, cell);
  return there ? static_cast<std::size_t>(found - at.begin()) : kNoBlock;
}

std::uint32_t SolidCells::run_at(std::size_t cell, BitIndex place) const {
  const Mask512& mask = solid[cell];
  assert(test(mask, place));
  std::uint32_t run = first[cell];
  for (std::size_t w = 0; w < place.word; ++w) {
    run += static_cast<std::uint32_t>(std::popcount(run_starts(mask[w])));
  }
  const std::uint64_t up_to = ~std::uint64_t{0} >> (63 - place.bit);
  return run - 1 + static_cast<std::uint32_t>(std::popcount(run_starts(mask[place.word]) & up_to));
}

CellJoiner::CellJoiner(Inside inside) : directions_(directions_of(inside)) {}

/// Joins the runs of one cell to each other.
void CellJoiner::join_within(const SolidCells& cells, std::size_t n,
                             std::vector<std::uint32_t>& parent) const {
  const Mask512& solid = cells.solid[n];
  for (std::size_t d = 0; d < directions_.size() / 2; ++d) {
    const auto [dx, dy, dz] = directions_[d];
    if (dy == 0 && dz == 0) continue;  // along a run
    for (std::size_t z = 0; z + static_cast<std::size_t>(dz) < 8; ++z) {
      const std::size_t other = z + static_cast<std::size_t>(dz);
      for_each_bit(run_starts(solid[z] & moved(solid[other], dx, dy)), [&](int bit) {
        const auto at = static_cast<unsigned>(bit);
        base::unite_sets(parent, cells.run_at(n, {z, at}),
                         cells.run_at(n, {other, static_cast<unsigned>(bit + 8 * dy + dx)}));
      });
    }
  }
}

/// Joins the runs of one cell to what lies beside it.
void CellJoiner::join_across(const SolidCells& cells, std::size_t n, const Whole& whole,
                             std::vector<std::uint32_t>& parent) const {
  CellsAround around(cells, n, whole);
  for (const Index3& d : directions_) {
    for (std::size_t z = 0; z < 8; ++z) {
      const bool leaves_z = d[2] != 0 && z == (d[2] > 0 ? 7U : 0U);
      const std::uint64_t from =
          cells.solid[n][z] & (leaves_z ? ~std::uint64_t{0} : leaving(d[0], d[1]));
      for_each_bit(from, [&](int bit) {
        const Index3 q = sum_of(place_of(z, bit), d);
        const CellsAround::Cell& other = around.at(block_of(q));
        std::uint32_t number = other.whole;
        if (other.listed != kNoBlock && test(cells.solid[other.listed], bit_index(q))) {
          number = cells.run_at(other.listed, bit_index(q));
        }
        if (number == kNone) return;
        base::unite_sets(parent, cells.run_at(n, {z, static_cast<unsigned>(bit)}), number);
      });
    }
  }
}

void CellJoiner::join(const SolidCells& cells, const Whole& whole,
                      std::vector<std::uint32_t>& parent) const {
  for (std::size_t n = 0; n < cells.at.size(); ++n) {
    join_within(cells, n, parent);
    join_across(cells, n, whole, parent);
  }
}

}  // namespace mc::extraction
