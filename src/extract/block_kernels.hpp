// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "extract/block_index.hpp"

// The kernels of the sparse engine: the same word arithmetic as on rows, on blocks of 8x8x8
// samples, where one word is a plane: word k, bit j*8 + i.

namespace mc::extraction {

/// Bits of a block and of its seven upper neighbours, at [x + 2y + 4z].
using BlockBits = std::array<Mask512, 8>;

/// Sample bits of leaf values in OpenVDB's order (x*64 + y*8 + z), turned to planes of k.
Mask512 planes_of(const Mask512& x_slices);

/// The edges that start in a block, crossed ones set; and how its vertices are numbered: plane by
/// plane, in a plane row by row, i before j, then the k-edges.
struct BlockEdges {
  Mask512 i{}, j{}, k{};
  std::array<std::uint16_t, 8> plane_start{};  ///< first vertex of plane k's i- and j-edges
  std::array<std::uint16_t, 8> k_start{};
  std::uint16_t n_vertices = 0;
};

/// Samples that exist, for blocks at the border of a region; all ones elsewhere.
/// Finds the crossed edges of a block; an edge needs both its samples.
BlockEdges find_edges(const BlockBits& above, const BlockBits& exists);

/// The cells of a block whose corners differ and all exist.
Mask512 find_cells(const BlockBits& above, const BlockBits& exists);
std::uint32_t count_block_triangles(const BlockBits& above, const Mask512& cells);

/// The blocks whose edges a block's cells use, at [x + 2y + 4z]: their edges, and the id of their
/// first vertex.
struct BlockNeighbours {
  std::array<const BlockEdges*, 8> edges{};
  std::array<std::uint32_t, 8> first{};
};

/// Writes triangles as emit_triangles() does. Returns the number of ids; room for 512 * 15.
std::size_t emit_block(const BlockBits& above, const Mask512& cells,
                       const BlockNeighbours& neighbours, bool flip, std::uint32_t* out);

}  // namespace mc::extraction
