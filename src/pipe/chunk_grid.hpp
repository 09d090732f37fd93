// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mc/field.hpp"

// How a volume is cut into chunks: cubes of cells, named by their coordinates. Chunk c holds the
// cells that start at samples c N to c N + N - 1 along each axis. The cells that lead to a closed
// border's constant layer belong to the chunks at the border.

namespace mc::pipe {

class ChunkGrid {
 public:
  /// `region` holds the samples that there are; `n_cells` is a power of two; `ring` is how many
  /// samples beyond its cells a chunk's normals look.
  ChunkGrid(const IndexBox& region, bool capped, std::int32_t n_cells, std::int32_t ring);

  /// Coordinates of all chunks, inclusive; none where the region holds no cell.
  [[nodiscard]] const IndexBox& chunks() const { return chunks_; }
  /// The samples that a chunk's cells lie between, those in the constant layer included.
  [[nodiscard]] IndexBox part(const Index3& id) const;
  /// The chunk that holds the cell which starts at a sample of the region or the constant layer.
  [[nodiscard]] Index3 chunk_of(const Index3& cell) const;
  /// Chunks whose cells or normals samples of the box can reach; an empty box where there are none.
  [[nodiscard]] IndexBox reached(const IndexBox& samples) const;

 private:
  IndexBox region_;
  std::int32_t pad_, ring_;
  int shift_;  ///< log2 of the cells along a chunk's edge
  IndexBox chunks_;
};

/// Numbers in a box; at most 2^63 - 1, as of 2^31 along each axis it could be more.
[[nodiscard]] std::uint64_t count_of(const IndexBox& box);
/// Appends all indices of a box, ordered by (z, y, x).
void append_all(const IndexBox& box, std::vector<Index3>& out);
/// Orders by (z, y, x) and leaves one of equals.
void sort_unique(std::vector<Index3>& ids);

}  // namespace mc::pipe
