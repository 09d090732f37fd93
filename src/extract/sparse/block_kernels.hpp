// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "extract/bits/cell.hpp"
#include "extract/sparse/block_index.hpp"

// The kernels of the sparse engine: the same word arithmetic as on rows, on blocks of 8x8x8
// samples, where one word is a plane: word k, bit j*8 + i. Compiled for every SIMD target and
// chosen at run time.

namespace mc::extraction {

/// Bits of a block and of its seven upper neighbours, at [x + 2y + 4z].
using BlockBits = std::array<const Mask512*, 8>;

/// Sample bits of leaf values in OpenVDB's order (x*64 + y*8 + z), turned to planes of k.
Mask512 planes_of(const Mask512& x_slices);

/// The edges that start in a block, crossed ones set, three words a plane. Their bits are in the
/// order of the vertices: row by row the i-edges, then the j-edges, four rows to a word; then the
/// k-edges. So the number of a vertex is the number of ones before its edge.
struct BlockEdges {
  static constexpr std::size_t kWords = 24;
  std::array<std::uint64_t, kWords> words;
  std::array<std::uint16_t, kWords> start;  ///< ones in the words before
  std::uint16_t n_vertices;
};

/// The vertex ids that a block's cells use: those on its own edges, and on edges that start in the
/// first plane, row or column of its upper neighbours. Only crossed edges have one.
struct IdTable {
  /// From one sample to the next along each axis, and from one axis' edges to the next's.
  static constexpr std::size_t kRow = 9, kPlane = 81, kAxis = 729;
  alignas(64) std::array<std::uint32_t, 3 * kAxis> ids;
};

/// Where an edge is: its lower sample in the block, the place of the samples at its ends among the
/// values of a leaf, and of its id.
struct EdgePlace {
  std::uint8_t i, j, k, axis;
  std::uint16_t lower;
  std::uint16_t upper;        ///< in the neighbour's values where it lies there
  std::uint8_t upper_source;  ///< 0: the same block; 1 + axis: the next along the axis
  std::uint16_t id;
};

/// Edges by their bit: word * 64 + bit.
inline constexpr std::size_t kBlockEdges = BlockEdges::kWords * 64;
using EdgePlaces1536 = std::array<EdgePlace, kBlockEdges>;
consteval EdgePlaces1536 edge_places() {
  EdgePlaces1536 places{};
  for (std::size_t n = 0; n < kBlockEdges; ++n) {
    const std::size_t word = n / 64;
    const std::size_t bit = n % 64;
    const bool along_k = word % 3 == 2;
    const std::size_t k = word / 3;
    const std::size_t j = along_k ? bit / 8 : word % 3 * 4 + bit / 16;
    const std::size_t i = bit % 8;
    const std::size_t axis = along_k ? 2 : bit / 8 % 2;
    const std::size_t along = axis == 0 ? i : axis == 1 ? j : k;
    const std::size_t stride = axis == 0 ? 64 : axis == 1 ? 8 : 1;
    const std::size_t lower = i * 64 + j * 8 + k;
    places[n] = {static_cast<std::uint8_t>(i),
                 static_cast<std::uint8_t>(j),
                 static_cast<std::uint8_t>(k),
                 static_cast<std::uint8_t>(axis),
                 static_cast<std::uint16_t>(lower),
                 static_cast<std::uint16_t>(along == 7 ? lower - 7 * stride : lower + stride),
                 static_cast<std::uint8_t>(along == 7 ? 1 + axis : 0),
                 static_cast<std::uint16_t>(axis * IdTable::kAxis + k * IdTable::kPlane +
                                            j * IdTable::kRow + i)};
  }
  return places;
}
inline constexpr EdgePlaces1536 kEdgePlaces = edge_places();

/// Finds the crossed edges of a block. `exists`, where not null, has ones for samples that there
/// are: an edge needs both its samples, a cell all its corners.
BlockEdges find_edges(const BlockBits& above, const BlockBits* exists);

/// The case of a block's cell, named by its lowest corner's place in the block.
[[nodiscard]] inline CellCase case_in(const BlockBits& above, const Index3& cell) {
  CellCase out;
  for (std::size_t c = 0; c < kCorners; ++c) {
    const Index3 p = Corner(c).of(cell);
    const auto block = static_cast<std::size_t>((p[0] >> 3) + 2 * (p[1] >> 3) + 4 * (p[2] >> 3));
    out.set(Corner(c), test(*above[block], field::bit_index(p)));
  }
  return out;
}

/// The cells of a block whose corners differ.
Mask512 find_cells(const BlockBits& above, const BlockBits* exists);
std::uint32_t count_block_triangles(const BlockBits& above, const Mask512& cells);

/// Lists crossed edges in the order of their vertices. Needs room for kBlockEdges + 3. Returns how
/// many.
std::size_t list_edges(const BlockEdges& edges, std::uint16_t* out);

/// Enters the ids of an upper neighbour's vertices, `neighbour` = x + 2y + 4z, not 0. `first` is
/// the id of its first vertex.
void enter_ids(std::size_t neighbour, const BlockEdges& edges, std::uint32_t first, IdTable& table);

/// Ids that emit_block() may write past the last.
inline constexpr std::size_t kBlockSlack = 16;
/// Writes triangles as emit_triangles() does. Returns the number of ids; needs room for 15 a cell
/// and kBlockSlack.
std::size_t emit_block(const BlockBits& above, const Mask512& cells, const IdTable& table,
                       bool flip, std::uint32_t* out);

}  // namespace mc::extraction
