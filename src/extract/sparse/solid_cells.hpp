// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "extract/sparse/block_masks.hpp"
#include "extract/sparse/block_walk.hpp"
#include "mc/extract.hpp"

// Cells of 8x8x8 places, each of which is solid or not, and which runs of solid places are
// connected. A cell is a block and its places are samples, or it is a node and its places are
// blocks: the same word arithmetic serves both.

namespace mc::extraction {

/// Ones for the first place of each run along x in a plane of places.
[[nodiscard]] inline std::uint64_t run_starts(std::uint64_t plane) {
  return plane & ~((plane & ~(kColumn0 << 7)) << 1);
}

/// The place in its cell of a bit of word `z`.
[[nodiscard]] inline Index3 place_of(std::size_t z, int bit) {
  return {bit & 7, bit >> 3, static_cast<std::int32_t>(z)};
}

[[nodiscard]] inline Index3 sum_of(const Index3& a, const Index3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

struct SolidCells {
  std::vector<Index3> at;             ///< ordered by (z, y, x)
  std::vector<field::Mask512> solid;  ///< of each cell
  std::vector<std::uint32_t> first;   ///< number of its first run

  /// The number of a cell, or kNoBlock.
  [[nodiscard]] std::size_t find(const Index3& cell) const;
  /// The number of the run that holds a solid place.
  [[nodiscard]] std::uint32_t run_at(std::size_t cell, field::BitIndex place) const;
};

/// Joins runs to components.
class CellJoiner {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  /// What a cell belongs to that is not listed: the number of something solid, or kNone.
  using Whole = std::function<std::uint32_t(const Index3& cell)>;

  /// Solid places are connected to 6 neighbours, or to 18 if the solid is below.
  explicit CellJoiner(Inside inside);

  /// To the neighbours of a place: those that come later in (z, y, x) order, then all others.
  [[nodiscard]] const std::vector<Index3>& directions() const { return directions_; }
  /// Joins the runs of all cells, to each other and to what lies beside the cells.
  void join(const SolidCells& cells, const Whole& whole, std::vector<std::uint32_t>& parent) const;

 private:
  void join_within(const SolidCells& cells, std::size_t n,
                   std::vector<std::uint32_t>& parent) const;
  void join_across(const SolidCells& cells, std::size_t n, const Whole& whole,
                   std::vector<std::uint32_t>& parent) const;

  std::vector<Index3> directions_;
};

}  // namespace mc::extraction
