// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include "extract/bits/row_kernels.hpp"

// The triangles of layers of cells, from their sample bits and the ids of their vertices. Compiled
// for every SIMD target and chosen at run time.

namespace mc::extraction {

/// One layer of cells: the planes below and above it, and the first ids of their rows.
struct CellLayer {
  BitPlane lower, upper;
  RowIds lower_ids, upper_ids;
  const std::uint32_t* k_ids = nullptr;
};

/// Ids that emit_triangles() may write past the last.
inline constexpr std::size_t kEmitSlack = 16;
/// Writes the triangles of cell rows [j0, j1) as vertex ids, three each, in cell order. `flip`
/// turns them round. Needs room for 15 ids a cell and kEmitSlack. Returns the number of ids.
std::size_t emit_triangles(const CellLayer& layer, std::size_t j0, std::size_t j1, bool flip,
                           std::uint32_t* out);
/// How many triangles the layer has.
std::uint64_t count_triangles(const BitPlane& lower, const BitPlane& upper);

}  // namespace mc::extraction
