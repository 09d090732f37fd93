// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see block_kernels.hpp for what the functions do.

#if defined(MC_EXTRACT_BLOCK_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_EXTRACT_BLOCK_KERNELS_INL
#undef MC_EXTRACT_BLOCK_KERNELS_INL
#else
#define MC_EXTRACT_BLOCK_KERNELS_INL
#endif

#include <hwy/highway.h>

#include <bit>

#include "extract/block_kernels.hpp"
#include "extract/case_table.hpp"

HWY_BEFORE_NAMESPACE();
namespace mc::extraction {
namespace HWY_NAMESPACE {

inline std::uint32_t ones(std::uint64_t word) {
  return static_cast<std::uint32_t>(std::popcount(word));
}

/// Ones below bit n, n <= 64.
inline std::uint64_t below(unsigned n) {
  return n >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << n) - 1;
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

/// One plane of the four corner columns of a block's cells: at (i, j), (i+1, j), (i, j+1), (i+1,
/// j+1).
struct PlaneCorners {
  std::uint64_t at[4];

  /// Plane k of 0..8; plane 8 is the first of the blocks above.
  PlaneCorners(const BlockBits& blocks, std::size_t k) {
    constexpr std::uint64_t kColumn0 = 0x0101010101010101ULL;
    const std::size_t z = k == 8 ? 4 : 0;
    const auto from_x = [](std::uint64_t m, std::uint64_t next) {
      return ((m & ~kColumn0) >> 1) | ((next & kColumn0) << 7);
    };
    const std::uint64_t m = blocks[z][k & 7U];
    const std::uint64_t mx = from_x(m, blocks[z + 1][k & 7U]);
    const std::uint64_t n = blocks[z + 2][k & 7U];
    const std::uint64_t nx = from_x(n, blocks[z + 3][k & 7U]);
    at[0] = m;
    at[1] = mx;
    at[2] = (m >> 8) | (n << 56);
    at[3] = (mx >> 8) | (nx << 56);
  }
};

BlockEdges find_edges(const BlockBits& above, const BlockBits& exists) {
  BlockEdges e;
  std::uint32_t n = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    const PlaneCorners b(above, k);
    const PlaneCorners there(exists, k);
    const PlaneCorners up(above, k + 1);
    const PlaneCorners up_there(exists, k + 1);
    e.i[k] = (b.at[0] ^ b.at[1]) & there.at[0] & there.at[1];
    e.j[k] = (b.at[0] ^ b.at[2]) & there.at[0] & there.at[2];
    e.k[k] = (b.at[0] ^ up.at[0]) & there.at[0] & up_there.at[0];
    e.plane_start[k] = static_cast<std::uint16_t>(n);
    n += ones(e.i[k]) + ones(e.j[k]);
    e.k_start[k] = static_cast<std::uint16_t>(n);
    n += ones(e.k[k]);
  }
  e.n_vertices = static_cast<std::uint16_t>(n);
  return e;
}

Mask512 find_cells(const BlockBits& above, const BlockBits& exists) {
  Mask512 cells;
  for (std::size_t k = 0; k < 8; ++k) {
    std::uint64_t any = 0;
    std::uint64_t all = ~std::uint64_t{0};
    std::uint64_t there = ~std::uint64_t{0};
    for (const std::size_t plane : {k, k + 1}) {
      const PlaneCorners b(above, plane);
      const PlaneCorners e(exists, plane);
      for (std::size_t c = 0; c < 4; ++c) {
        any |= b.at[c];
        all &= b.at[c];
        there &= e.at[c];
      }
    }
    cells[k] = any & ~all & there;
  }
  return cells;
}

inline unsigned case_at(const PlaneCorners& lower, const PlaneCorners& upper, unsigned bit) {
  unsigned out = 0;
  for (unsigned c = 0; c < 4; ++c) {
    out |= static_cast<unsigned>((lower.at[c] >> bit) & 1U) << c;
    out |= static_cast<unsigned>((upper.at[c] >> bit) & 1U) << (c + 4);
  }
  return out;
}

std::uint32_t count_block_triangles(const BlockBits& above, const Mask512& cells) {
  std::uint32_t n = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    if (cells[k] == 0) continue;
    const PlaneCorners lower(above, k);
    const PlaneCorners upper(above, k + 1);
    for (std::uint64_t m = cells[k]; m != 0; m &= m - 1) {
      n += kCases[case_at(lower, upper, static_cast<unsigned>(std::countr_zero(m)))].n_triangles;
    }
  }
  return n;
}

/// The id of the vertex on edge `axis` at (i, j, k) of a block, each in 0..7.
inline std::uint32_t vertex_id(const BlockEdges& e, std::uint32_t first, unsigned i, unsigned j,
                               unsigned k, int axis) {
  const unsigned bit = 8 * j + i;
  if (axis == 2) {
    return first + e.k_start[k] + ones(e.k[k] & below(bit));
  }
  const unsigned i_before = axis == 0 ? bit : 8 * (j + 1);
  const unsigned j_before = axis == 0 ? 8 * j : bit;
  return first + e.plane_start[k] + ones(e.i[k] & below(i_before)) + ones(e.j[k] & below(j_before));
}

std::size_t emit_block(const BlockBits& above, const Mask512& cells,
                       const BlockNeighbours& neighbours, bool flip, std::uint32_t* out) {
  std::uint32_t* const begin = out;
  const std::size_t second = flip ? 2 : 1;
  const std::size_t third = flip ? 1 : 2;
  for (unsigned k = 0; k < 8; ++k) {
    if (cells[k] == 0) continue;
    const PlaneCorners lower(above, k);
    const PlaneCorners upper(above, k + 1);
    for (std::uint64_t m = cells[k]; m != 0; m &= m - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(m));
      const unsigned cell_case = case_at(lower, upper, bit);
      const CaseRow& row = kCases[cell_case];
      std::uint32_t ids[kEdges];
      for (int edge = 0; edge < kEdges; ++edge) {
        const EdgeEnds ends = edge_ends(edge);
        if (((cell_case >> ends.corner) & 1U) ==
            ((cell_case >> (ends.corner | (1 << ends.axis))) & 1U)) {
          continue;
        }
        const unsigned i = (bit & 7U) + static_cast<unsigned>(ends.corner & 1);
        const unsigned j = (bit >> 3U) + static_cast<unsigned>(ends.corner >> 1 & 1);
        const unsigned p = k + static_cast<unsigned>(ends.corner >> 2 & 1);
        const std::size_t owner = (i >> 3U) + 2 * (j >> 3U) + 4 * (p >> 3U);
        ids[edge] = vertex_id(*neighbours.edges[owner], neighbours.first[owner], i & 7U, j & 7U,
                              p & 7U, ends.axis);
      }
      for (std::size_t t = 0; t < row.n_triangles; ++t) {
        out[0] = ids[row.edges[3 * t]];
        out[1] = ids[row.edges[3 * t + second]];
        out[2] = ids[row.edges[3 * t + third]];
        out += 3;
      }
    }
  }
  return static_cast<std::size_t>(out - begin);
}

}  // namespace HWY_NAMESPACE
}  // namespace mc::extraction
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
