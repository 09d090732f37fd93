// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see block_kernels.hpp for what the functions do.

#if defined(MC_EXTRACT_SPARSE_BLOCK_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_EXTRACT_SPARSE_BLOCK_KERNELS_INL
#undef MC_EXTRACT_SPARSE_BLOCK_KERNELS_INL
#else
#define MC_EXTRACT_SPARSE_BLOCK_KERNELS_INL
#endif

#include <hwy/highway.h>

#include <array>
#include <bit>

#include "extract/cubes/case_table.hpp"
#include "extract/sparse/block_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::extraction::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline std::uint32_t ones(std::uint64_t word) {
  return static_cast<std::uint32_t>(std::popcount(word));
}

/// Transposes 8x8 bits: bit 8r + c goes to 8c + r (Warren, Hacker's Delight, section 7-3).
inline std::uint64_t transposed(std::uint64_t m) {
  const auto swap = [&m](std::uint64_t mask, unsigned distance) {
    const std::uint64_t t = (m ^ (m >> distance)) & mask;
    m ^= t ^ (t << distance);
  };
  swap(0x00AA00AA00AA00AAULL, 7);
  swap(0x0000CCCC0000CCCCULL, 14);
  swap(0x00000000F0F0F0F0ULL, 28);
  return m;
}

Mask512 planes_of(const Mask512& x_slices) {
  Mask512 planes{};
  for (unsigned y = 0; y < 8; ++y) {
    std::uint64_t rows = 0;
    for (unsigned x = 0; x < 8; ++x) {
      rows |= ((x_slices[x] >> (8 * y)) & 0xFFU) << (8 * x);
    }
    rows = transposed(rows);
    for (unsigned z = 0; z < 8; ++z) {
      planes[z] |= ((rows >> (8 * z)) & 0xFFU) << (8 * y);
    }
  }
  return planes;
}

/// The corners of a block's cells: those of plane k at (i, j), (i+1, j), (i, j+1), (i+1, j+1), so
/// that the eight words from at[k] on are the corners of a layer of cells in order.
struct BlockCorners {
  std::uint64_t at[9][4];

  explicit BlockCorners(const BlockBits& blocks) {
    for (std::size_t k = 0; k < 8; ++k) set_plane(k, blocks.data(), k);
    set_plane(8, blocks.data() + 4, 0);
  }

 private:
  void set_plane(std::size_t k, const Mask512* const* blocks, std::size_t word) {
    constexpr std::uint64_t kColumn0 = 0x0101010101010101ULL;
    const auto from_x = [](std::uint64_t m, std::uint64_t next) {
      return ((m & ~kColumn0) >> 1) | ((next & kColumn0) << 7);
    };
    const std::uint64_t m = (*blocks[0])[word];
    const std::uint64_t n = (*blocks[2])[word];
    const std::uint64_t mx = from_x(m, (*blocks[1])[word]);
    const std::uint64_t nx = from_x(n, (*blocks[3])[word]);
    at[k][0] = m;
    at[k][1] = mx;
    at[k][2] = (m >> 8) | (n << 56);
    at[k][3] = (mx >> 8) | (nx << 56);
  }
};

/// Moves the bytes of a word's lower half apart.
inline std::uint64_t spread(std::uint64_t m) {
  m = (m | (m << 16)) & 0x0000FFFF0000FFFFULL;
  return (m | (m << 8)) & 0x00FF00FF00FF00FFULL;
}

BlockEdges find_edges(const BlockBits& above, const BlockBits* exists) {
  const BlockCorners b(above);
  std::uint64_t crossed[8][3];
  for (std::size_t k = 0; k < 8; ++k) {
    crossed[k][0] = b.at[k][0] ^ b.at[k][1];
    crossed[k][1] = b.at[k][0] ^ b.at[k][2];
    crossed[k][2] = b.at[k][0] ^ b.at[k + 1][0];
  }
  if (exists != nullptr) {
    const BlockCorners there(*exists);
    for (std::size_t k = 0; k < 8; ++k) {
      crossed[k][0] &= there.at[k][0] & there.at[k][1];
      crossed[k][1] &= there.at[k][0] & there.at[k][2];
      crossed[k][2] &= there.at[k][0] & there.at[k + 1][0];
    }
  }
  BlockEdges e;
  for (std::size_t k = 0; k < 8; ++k) {
    const std::uint64_t i = crossed[k][0];
    const std::uint64_t j = crossed[k][1];
    e.words[3 * k] = spread(i & 0xFFFFFFFFU) | (spread(j & 0xFFFFFFFFU) << 8);
    e.words[3 * k + 1] = spread(i >> 32) | (spread(j >> 32) << 8);
    e.words[3 * k + 2] = crossed[k][2];
  }
  std::uint32_t n = 0;
  for (std::size_t w = 0; w < BlockEdges::kWords; ++w) {
    e.start[w] = static_cast<std::uint16_t>(n);
    n += ones(e.words[w]);
  }
  e.n_vertices = static_cast<std::uint16_t>(n);
  return e;
}

Mask512 find_cells(const BlockBits& above, const BlockBits* exists) {
  const BlockCorners b(above);
  Mask512 cells;
  for (std::size_t k = 0; k < 8; ++k) {
    std::uint64_t any = 0;
    std::uint64_t all = ~std::uint64_t{0};
    for (std::size_t c = 0; c < 8; ++c) {
      any |= b.at[k + c / 4][c % 4];
      all &= b.at[k + c / 4][c % 4];
    }
    cells[k] = any & ~all;
  }
  if (exists != nullptr) {
    const BlockCorners there(*exists);
    for (std::size_t k = 0; k < 8; ++k) {
      for (std::size_t c = 0; c < 8; ++c) cells[k] &= there.at[k + c / 4][c % 4];
    }
  }
  return cells;
}

/// The case of the cell at a bit of a layer: `layer` is BlockCorners::at from its lower plane on.
inline unsigned case_at(const std::uint64_t (*layer)[4], unsigned bit) {
  unsigned out = 0;
  for (unsigned c = 0; c < 8; ++c) {
    out |= static_cast<unsigned>((layer[c / 4][c % 4] >> bit) & 1U) << c;
  }
  return out;
}

std::uint32_t count_block_triangles(const BlockBits& above, const Mask512& cells) {
  const BlockCorners corners(above);
  std::uint32_t n = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    for (std::uint64_t m = cells[k]; m != 0; m &= m - 1) {
      n += kCases[case_at(corners.at + k, static_cast<unsigned>(std::countr_zero(m)))].n_triangles;
    }
  }
  return n;
}

std::size_t list_edges(const BlockEdges& edges, std::uint16_t* out) {
  const std::uint16_t* const begin = out;
  for (std::size_t w = 0; w < BlockEdges::kWords; ++w) {
    std::uint64_t word = edges.words[w];
    if (word == 0) continue;
    const auto base = static_cast<unsigned>(64 * w);
    std::uint16_t* const end = out + ones(word);
    for (;;) {  // four at once: a loop over single bits would be mispredicted at every end
      for (std::size_t n = 0; n < 4; ++n) {
        out[n] = static_cast<std::uint16_t>(base + static_cast<unsigned>(std::countr_zero(word)));
        word &= word - 1;
      }
      if (word == 0) break;
      out += 4;
    }
    out = end;
  }
  return static_cast<std::size_t>(out - begin);
}

/// The edges of an upper neighbour that a block's cells use, as BlockEdges::words.
consteval std::array<std::uint64_t, BlockEdges::kWords> shared_edges(std::size_t neighbour) {
  std::array<std::uint64_t, BlockEdges::kWords> masks{};
  for (std::size_t n = 0; n < kBlockEdges; ++n) {
    const EdgePlace& p = kEdgePlaces[n];
    const std::size_t at[3] = {p.i, p.j, p.k};
    bool shared = true;
    for (std::size_t a = 0; a < 3; ++a) {
      shared = shared && ((neighbour >> a & 1U) == 0 || (at[a] == 0 && p.axis != a));
    }
    if (shared) masks[n / 64] |= std::uint64_t{1} << (n % 64);
  }
  return masks;
}
constexpr std::array<std::uint64_t, BlockEdges::kWords> kSharedEdges[8] = {
    shared_edges(0), shared_edges(1), shared_edges(2), shared_edges(3),
    shared_edges(4), shared_edges(5), shared_edges(6), shared_edges(7)};

void enter_ids(std::size_t neighbour, const BlockEdges& edges, std::uint32_t first,
               IdTable& table) {
  const std::array<std::uint64_t, BlockEdges::kWords>& shared = kSharedEdges[neighbour];
  std::uint32_t* const ids =
      table.ids.data() + 8 * ((neighbour & 1U) + (neighbour >> 1 & 1U) * IdTable::kRow +
                              (neighbour >> 2) * IdTable::kPlane);
  const std::size_t n_words = neighbour >= 4 ? 3 : BlockEdges::kWords;  // one plane, or all
  for (std::size_t w = 0; w < n_words; ++w) {
    const std::uint64_t word = edges.words[w];
    for (std::uint64_t m = word & shared[w]; m != 0; m &= m - 1) {
      const std::uint64_t before = word & ((m & (~m + 1)) - 1);
      ids[kEdgePlaces[64 * w + static_cast<std::size_t>(std::countr_zero(m))].id] =
          first + edges.start[w] + ones(before);
    }
  }
}

/// The triangles of each case as places in the id table, counted from the cell's own; in the last
/// place their number of ids.
struct PlaceTable {
  alignas(64) std::uint16_t rows[256][16];

  explicit PlaceTable(bool flip) {
    for (std::size_t c = 0; c < 256; ++c) {
      const CaseRow& row = kCases[c];
      for (std::size_t n = 0; n < 15; ++n) {
        const CellEdge edge = edge_at(row, n, flip);
        const std::size_t corner = edge.lower();
        rows[c][n] = static_cast<std::uint16_t>(edge.axis() * IdTable::kAxis + (corner & 1U) +
                                                (corner >> 1 & 1U) * IdTable::kRow +
                                                (corner >> 2) * IdTable::kPlane);
      }
      rows[c][15] = static_cast<std::uint16_t>(3 * row.n_triangles);
    }
  }
};

const PlaceTable& place_table(bool flip) {
  static const PlaceTable kTables[2] = {PlaceTable(false), PlaceTable(true)};
  return kTables[flip ? 1 : 0];
}

#if HWY_TARGET == HWY_AVX3_DL || HWY_TARGET == HWY_AVX3

/// Writes the triangles of one layer's cells: all fifteen ids that a case can have are gathered and
/// stored, of which the case's number count.
inline std::uint32_t* emit_layer(const std::uint64_t (*layer)[4], std::uint64_t cells,
                                 const std::uint32_t* ids, const PlaceTable& table,
                                 std::uint32_t* out) {
  const hn::FixedTag<std::uint64_t, 8> d;
  const hn::FixedTag<std::int32_t, 16> lanes;
  const hn::Rebind<std::uint16_t, decltype(lanes)> halves;
  const auto corners = hn::LoadU(d, layer[0]);
  for (; cells != 0; cells &= cells - 1) {
    const auto bit = static_cast<std::size_t>(std::countr_zero(cells));
    std::uint8_t cell_case = 0;
    hn::StoreMaskBits(d, hn::TestBit(corners, hn::Set(d, cells & (~cells + 1))), &cell_case);
    const std::uint16_t* row = table.rows[cell_case];
    const auto places = hn::PromoteTo(lanes, hn::Load(halves, row));
    const auto* from =
        reinterpret_cast<const std::int32_t*>(ids + bit / 8 * IdTable::kRow + bit % 8);
    hn::StoreU(hn::GatherIndex(lanes, from, places), lanes, reinterpret_cast<std::int32_t*>(out));
    out += row[15];
  }
  return out;
}

#else

inline std::uint32_t* emit_layer(const std::uint64_t (*layer)[4], std::uint64_t cells,
                                 const std::uint32_t* ids, const PlaceTable& table,
                                 std::uint32_t* out) {
  for (; cells != 0; cells &= cells - 1) {
    const auto bit = static_cast<std::size_t>(std::countr_zero(cells));
    const std::uint16_t* row = table.rows[case_at(layer, static_cast<unsigned>(bit))];
    const std::uint32_t* from = ids + bit / 8 * IdTable::kRow + bit % 8;
    for (std::size_t n = 0; n < row[15]; ++n) *out++ = from[row[n]];
  }
  return out;
}

#endif

std::size_t emit_block(const BlockBits& above, const Mask512& cells, const IdTable& table,
                       bool flip, std::uint32_t* out) {
  const BlockCorners corners(above);
  const PlaceTable& places = place_table(flip);
  const std::uint32_t* const begin = out;
  for (std::size_t k = 0; k < 8; ++k) {
    out = emit_layer(corners.at + k, cells[k], table.ids.data() + k * IdTable::kPlane, places, out);
  }
  return static_cast<std::size_t>(out - begin);
}

}  // namespace mc::extraction::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
