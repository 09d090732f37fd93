// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

#include "extract/block_index.hpp"
#include "extract/block_kernels.hpp"
#include "extract/surface_sums.hpp"
#include "extract/vertex_writer.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"

// Flying Edges over the blocks of a sparse volume: nothing is densified. A block's samples are
// eight words; the blocks that can hold a surface are found from the tree alone; each owns the
// vertices on the edges that start in it. Blocks go by (z, y, x) of their origin, vertices and
// cells in a block in the dense engine's order: the same vertices and triangles as from a dense
// copy, numbered block by block.
//
// Planning classifies every leaf once and counts every block's vertices, so that any block's ids
// are known before anything is made. Blocks are then made in runs, which share nothing but the
// plan.

namespace mc::extraction {

/// What all runs of one extraction share. Constant once built.
class SparsePlan {
 public:
  /// Errors: limit, where the volume reaches past the indices that fit.
  /// Cost: one read of all leaves; 64 bytes a leaf, 20 a block that may hold a surface.
  SparsePlan(const LeafReader& reader, const Affine& to_world, const ExtractOptions& options);

  [[nodiscard]] std::size_t n_blocks() const { return blocks_.size(); }
  [[nodiscard]] std::uint64_t bytes() const;
  [[nodiscard]] std::uint64_t n_vertices() const { return first_.back(); }

 private:
  friend class SparseExtractor;

  void classify_leaves();
  void find_blocks();
  void add_region_faces();
  void count_blocks();
  [[nodiscard]] BlockBits bits_around(const Index3& block) const;
  [[nodiscard]] BlockBits exists_around(const Index3& block) const;
  [[nodiscard]] Mask512 bits_of(const Index3& block) const;
  [[nodiscard]] Mask512 inside_region(const Index3& block, std::int32_t margin) const;
  [[nodiscard]] std::size_t find(const Index3& block) const;

  const LeafReader& reader_;
  Affine to_world_;
  ExtractOptions options_;
  Placement placement_;
  Threshold threshold_;
  BlockIndex index_;
  IndexBox box_;  ///< the region, or all indices there are
  bool capped_;
  bool above_outside_;
  Vec3 apex_;
  std::vector<Mask512> leaf_bits_;
  std::vector<Index3> blocks_;        ///< that may hold a surface, ordered by (z, y, x)
  std::vector<std::uint64_t> first_;  ///< id of each block's first vertex, and the end
  std::vector<std::uint16_t> n_triangles_;
};

/// Makes runs of blocks. Holds scratch: one to a thread.
class SparseExtractor {
 public:
  explicit SparseExtractor(const SparsePlan& plan) : plan_(plan) {}

  /// Makes blocks [first, last). Indices in `chunk` count from the run's first vertex.
  /// Errors: limit, where a triangle spans more than 2^32 vertex ids.
  void extract(std::size_t first, std::size_t last, MeshChunk& chunk, TaskTotals& totals);
  /// Only counts, from the plan.
  void count(std::size_t first, std::size_t last, TaskTotals& totals) const;

 private:
  template <class T>
  void extract_typed(std::size_t first, std::size_t last, MeshChunk& chunk, TaskTotals& totals);
  template <class Writer>
  static void write_vertices(const BlockEdges& edges, const Index3& origin, Writer& writer);
  void emit_triangles(std::size_t n, std::uint64_t base, const BlockBits& above,
                      const Mask512& cells, MeshChunk& chunk);
  [[nodiscard]] std::uint64_t boundary_edges(const Index3& block, const BlockBits& above,
                                             const Mask512& cells) const;
  const BlockEdges& edges_of(std::size_t n);

  struct CachedEdges {
    std::size_t block = static_cast<std::size_t>(-1);
    BlockEdges edges;
  };
  static constexpr std::size_t kCached = 1024;  // direct-mapped: about two rows of blocks

  const SparsePlan& plan_;
  std::vector<CachedEdges> cache_;
  std::vector<std::byte> leaf_scratch_;
  std::tuple<EdgeBatch<float>, EdgeBatch<double>> batches_;
};

}  // namespace mc::extraction
