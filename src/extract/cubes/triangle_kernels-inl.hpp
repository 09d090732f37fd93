// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: from active cells to triangles.

#if defined(MC_EXTRACT_CUBES_TRIANGLE_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_EXTRACT_CUBES_TRIANGLE_KERNELS_INL
#undef MC_EXTRACT_CUBES_TRIANGLE_KERNELS_INL
#else
#define MC_EXTRACT_CUBES_TRIANGLE_KERNELS_INL
#endif

#include <hwy/highway.h>

#include "extract/bits/row_words-inl.hpp"
#include "extract/cubes/case_table.hpp"
#include "extract/cubes/triangle_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::extraction::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A row of cells on its way to triangles.
struct CellRow {
  const std::uint64_t* rows[4];
  const std::uint64_t* cells;
  const std::uint32_t* ids;  ///< of the first vertex of each row of edges, see pack_ids()
};

/// Rows of cells that are emitted together.
constexpr std::size_t kRowsAtOnce = 32;
constexpr std::size_t kEdgeRows = 8;

/// Eight rows of crossed edges surround a row of cells: four of i-edges, then two each of j- and
/// k-edges, which a cell uses at its bit and at the next. Their ids are laid side by side a while
/// before they are read as one vector.
void pack_ids(const CellLayer& l, std::size_t j0, std::size_t j1, std::uint32_t* out) {
  for (std::size_t j = j0; j < j1; ++j, out += kEdgeRows) {
    out[0] = l.lower_ids.i[j];
    out[1] = l.lower_ids.i[j + 1];
    out[2] = l.upper_ids.i[j];
    out[3] = l.upper_ids.i[j + 1];
    out[4] = l.lower_ids.j[j];
    out[5] = l.upper_ids.j[j];
    out[6] = l.k_ids[j];
    out[7] = l.k_ids[j + 1];
  }
}

#if HWY_TARGET == HWY_AVX3_DL

/// Where the vertex of a cell's edge is among sixteen ids: each row's id at the cell, then at the
/// next one.
constexpr std::uint8_t lane_of_edge(CellEdge edge) {
  return static_cast<std::uint8_t>(edge < 4 ? 2 * edge : edge + 4);
}

/// The triangles of each case as lanes of the ids, and in the last byte their number.
struct LaneTable {
  alignas(64) std::uint8_t rows[256][16];

  explicit LaneTable(bool flip) {
    for (std::size_t c = 0; c < 256; ++c) {
      const CaseRow& row = kCases[c];
      for (std::size_t n = 0; n < 15; ++n) {
        rows[c][n] = lane_of_edge(edge_at(row, n, flip));
      }
      rows[c][15] = static_cast<std::uint8_t>(3 * row.n_triangles);
    }
  }
};

const LaneTable& lane_table(bool flip) {
  static const LaneTable tables[2] = {LaneTable(false), LaneTable(true)};
  return tables[flip ? 1 : 0];
}

/// Emits the active cells of a row, a cell in about twenty instructions and without a branch on
/// its case. Eight lanes hold the words of the eight corners: testing all lanes for one bit is the
/// case. Eight hold the rows of crossed edges: their ones below the bit, counted by lane, are the
/// ids at the cell, and with the bit itself the ids at the next. The case's row of the table then
/// permutes these sixteen ids into at most five triangles, all stored, of which the case's number
/// count.
class RowEmitter {
 public:
  explicit RowEmitter(bool flip) : table_(lane_table(flip).rows) {}

  std::uint32_t* emit(const CellRow& row, std::size_t n_words, std::uint32_t* out) const {
    const hn::Rebind<std::uint32_t, Words> half;
    const Words d;
    WordVector ids = hn::PromoteTo(d, hn::LoadU(half, row.ids));
    ids = hn::Or(ids, hn::ShiftLeft<32>(ids));
    for_each_word(ActiveCells{row.rows, row.cells}, n_words,
                  [&](std::size_t w, std::uint64_t active) {
                    const WordVector above = corners(row, w);
                    const WordVector crossed = crossings(above, row.cells[w]);
                    out = emit_word(above, crossed, ids, active, out);
                    const WordVector n = hn::PopulationCount(crossed);
                    ids = hn::Add(ids, hn::Or(n, hn::ShiftLeft<32>(n)));
                  });
    return out;
  }

 private:
  static WordVector corners(const CellRow& row, std::size_t w) {
    const hn::FixedTag<std::uint64_t, 2> d2;
    const hn::FixedTag<std::uint64_t, 4> d4;
    const Words d;
    const auto pair = [&](std::size_t r) { return hn::LoadU(d2, row.rows[r] + w); };
    const auto both =
        hn::Combine(d, hn::Combine(d4, pair(3), pair(2)), hn::Combine(d4, pair(1), pair(0)));
    const auto here = hn::DupEven(both);
    const auto next = hn::Or(hn::ShiftRight<1>(here), hn::ShiftLeft<63>(hn::DupOdd(both)));
    return hn::OddEven(next, here);
  }

  static WordVector crossings(WordVector above, std::uint64_t cells) {
    const Words d;
    HWY_ALIGN static constexpr std::uint64_t kLower[8] = {0, 2, 4, 6, 0, 4, 0, 2};
    HWY_ALIGN static constexpr std::uint64_t kUpper[8] = {1, 3, 5, 7, 2, 6, 4, 6};
    const auto lower = hn::TableLookupLanes(above, hn::SetTableIndices(d, kLower));
    const auto upper = hn::TableLookupLanes(above, hn::SetTableIndices(d, kUpper));
    const auto crossed = hn::Xor(lower, upper);
    return hn::IfThenElse(hn::FirstN(d, 4), hn::And(crossed, hn::Set(d, cells)), crossed);
  }

  std::uint32_t* emit_word(WordVector above, WordVector crossed, WordVector ids,
                           std::uint64_t active, std::uint32_t* out) const {
    const Words d;
    const hn::Repartition<std::uint32_t, Words> lanes;
    const hn::Rebind<std::uint8_t, decltype(lanes)> bytes;
    for (; active != 0; active &= active - 1) {
      const WordVector bit = hn::Set(d, active & (~active + 1));
      const WordVector below = hn::Set(d, (active & (~active + 1)) - 1);
      std::uint8_t cell_case = 0;
      hn::StoreMaskBits(d, hn::TestBit(above, bit), &cell_case);
      const WordVector here = hn::PopulationCount(hn::And(crossed, below));
      const WordVector next = hn::PopulationCount(hn::And(crossed, hn::Or(below, bit)));
      const WordVector at = hn::Add(ids, hn::Or(here, hn::ShiftLeft<32>(next)));
      const std::uint8_t* row = table_[cell_case];
      const auto order = hn::PromoteTo(lanes, hn::Load(bytes, row));
      hn::StoreU(hn::TableLookupLanes(hn::BitCast(lanes, at), hn::IndicesFromVec(lanes, order)),
                 lanes, out);
      out += row[15];
    }
    return out;
  }

  const std::uint8_t (*table_)[16];
};

#else

/// The twelve vertex ids of a cell.
struct CellIds {
  std::uint32_t next[8];  ///< id of the first crossed edge of each row in this word
  std::uint64_t crossed[8];

  void set_words(const CornerWords& s, std::uint64_t cells) {
    for (std::size_t r = 0; r < 4; ++r) {
      crossed[r] = (s.at[2 * r] ^ s.at[2 * r + 1]) & cells;
    }
    crossed[4] = s.at[0] ^ s.at[2];
    crossed[5] = s.at[4] ^ s.at[6];
    crossed[6] = s.at[0] ^ s.at[4];
    crossed[7] = s.at[2] ^ s.at[6];
  }
  void pass_word() {
    for (std::size_t r = 0; r < 8; ++r) {
      next[r] += ones(crossed[r]);
    }
  }
  void at_bit(unsigned bit, std::uint32_t ids[12]) const {
    const std::uint64_t below = (std::uint64_t{1} << bit) - 1;
    for (std::size_t r = 0; r < 4; ++r) {
      ids[r] = next[r] + ones(crossed[r] & below);
    }
    for (std::size_t r = 4; r < 8; ++r) {
      const std::uint32_t id = next[r] + ones(crossed[r] & below);
      ids[2 * r - 4] = id;
      ids[2 * r - 3] = id + static_cast<std::uint32_t>((crossed[r] >> bit) & 1U);
    }
  }
};

class RowEmitter {
 public:
  explicit RowEmitter(bool flip) : second_(flip ? 2 : 1), third_(flip ? 1 : 2) {}

  std::uint32_t* emit(const CellRow& row, std::size_t n_words, std::uint32_t* out) const {
    CellIds cell;
    std::copy(row.ids, row.ids + kEdgeRows, cell.next);
    for_each_word(ActiveCells{row.rows, row.cells}, n_words,
                  [&](std::size_t w, std::uint64_t active) {
                    const CornerWords corners(row.rows, w);
                    cell.set_words(corners, row.cells[w]);
                    out = emit_word(corners, cell, active, out);
                    cell.pass_word();
                  });
    return out;
  }

 private:
  std::uint32_t* emit_word(const CornerWords& corners, const CellIds& cell, std::uint64_t active,
                           std::uint32_t* out) const {
    for (; active != 0; active &= active - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(active));
      std::uint32_t ids[12];
      cell.at_bit(bit, ids);
      const CaseRow& triangles = kCases[corners.cell_case(bit)];
      for (std::size_t t = 0; t < triangles.n_triangles; ++t) {
        out[0] = ids[triangles.edges[3 * t]];
        out[1] = ids[triangles.edges[3 * t + second_]];
        out[2] = ids[triangles.edges[3 * t + third_]];
        out += 3;
      }
    }
    return out;
  }

  std::size_t second_, third_;
};

#endif

std::size_t emit_triangles(const CellLayer& layer, std::size_t j0, std::size_t j1, bool flip,
                           std::uint32_t* out) {
  const RowEmitter emitter(flip);
  const BitPlane& lower = layer.lower;
  const BitPlane& upper = layer.upper;
  std::uint32_t* const first = out;
  HWY_ALIGN std::uint32_t ids[kRowsAtOnce * kEdgeRows];
  for (std::size_t begin = j0; begin < j1; begin += kRowsAtOnce) {
    const std::size_t end = j1 - begin < kRowsAtOnce ? j1 : begin + kRowsAtOnce;
    pack_ids(layer, begin, end, ids);
    for (std::size_t j = begin; j < end; ++j) {
      const CellRow row{{lower.row(j), lower.row(j + 1), upper.row(j), upper.row(j + 1)},
                        lower.cells,
                        ids + (j - begin) * kEdgeRows};
      out = emitter.emit(row, lower.words_in_use(), out);
    }
  }
  return static_cast<std::size_t>(out - first);
}

std::uint64_t count_triangles(const BitPlane& lower, const BitPlane& upper) {
  std::uint64_t n = 0;
  for (std::size_t j = 0; j + 1 < lower.n_rows; ++j) {
    const std::uint64_t* const rows[4] = {lower.row(j), lower.row(j + 1), upper.row(j),
                                          upper.row(j + 1)};
    for_each_word(ActiveCells{rows, lower.cells}, lower.words_in_use(),
                  [&](std::size_t w, std::uint64_t active) {
                    const CornerWords corners(rows, w);
                    for (; active != 0; active &= active - 1) {
                      const auto bit = static_cast<unsigned>(std::countr_zero(active));
                      n += kCases[corners.cell_case(bit)].n_triangles;
                    }
                  });
  }
  return n;
}

}  // namespace mc::extraction::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
