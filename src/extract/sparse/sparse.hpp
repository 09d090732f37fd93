// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <tuple>
#include <vector>

#include "extract/cubes/surface_sums.hpp"
#include "extract/cubes/vertex_writer.hpp"
#include "extract/sparse/block_kernels.hpp"
#include "extract/sparse/block_walk.hpp"
#include "extract/sparse/leaf_queue.hpp"
#include "extract/sparse/sparse_plan.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"
#include "mc/method.hpp"
#include "mesh/chunk_room.hpp"

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

/// Makes runs of blocks. Holds scratch: one to a thread.
class SparseExtractor final : public BlockWorker {
 public:
  SparseExtractor(const SparsePlan& plan, const Affine& to_world);

  std::size_t extract(std::size_t first, std::size_t last, std::uint64_t max_bytes,
                      MeshChunk& chunk, SurfaceTotals& totals) override;
  /// Counts from the plan's bits.
  void count(std::size_t first, std::size_t last, SurfaceTotals& totals) override;

  /// Bytes of scratch, for what is allocated once.
  static std::uint64_t scratch_bytes();
  /// Bytes of chunk that so many blocks make at most.
  static std::uint64_t most_bytes_of(std::size_t n_blocks, const ExtractOptions& options);

 private:
  using Walk = BlockWalk<3>;

  struct KnownEdges {
    std::size_t block = kNoBlock;
    std::uint64_t first = 0;
    BlockEdges edges;
  };
  static constexpr std::size_t kKnown = 1024;  // direct-mapped: about two rows of blocks

  template <class T>
  std::size_t extract_typed(std::size_t first, std::size_t last, mesh::ChunkRoom& room,
                            SurfaceTotals& totals);
  template <class Sampler, class Writer>
  void write_vertices(const Index3& block, bool at_border, Sampler& sampler, Writer& writer);
  void emit_triangles(const Walk& walk, std::uint64_t base, const BlockBits& above,
                      const Mask512& cells, MeshChunk& chunk);
  [[nodiscard]] std::uint64_t boundary_edges(const Index3& block, const BlockBits& above,
                                             const Mask512& cells) const;
  const KnownEdges& edges_at(const Walk& walk, std::size_t x, std::size_t y, std::size_t z);

  const SparsePlan& plan_;
  Affine to_world_;
  Placement placement_;
  Vec3 apex_;
  std::vector<KnownEdges> known_;
  std::array<std::uint16_t, kBlockEdges + 4> edges_{};  // of the block that is being made
  std::size_t n_edges_ = 0;
  IdTable ids_;
  BlockSamples samples_;
  LeafQueue queue_;
  std::vector<std::byte> ring_scratch_;
  std::tuple<EdgeBatch<float>, EdgeBatch<double>> batches_;
};

/// A plan and what makes its blocks.
class SparseEngine final : public BlockEngine {
 public:
  SparseEngine(const LeafReader& reader, const Affine& to_world, const ExtractOptions& options)
      : plan_(reader, options), to_world_(to_world) {}

  [[nodiscard]] std::size_t n_blocks() const override { return plan_.n_own(); }
  [[nodiscard]] std::int32_t layer(std::size_t n) const override { return plan_.blocks()[n].at[2]; }
  [[nodiscard]] std::uint64_t first_vertex(std::size_t n) const override {
    return plan_.first_vertex(n);
  }
  [[nodiscard]] std::unique_ptr<BlockWorker> worker() const override {
    return std::make_unique<SparseExtractor>(plan_, to_world_);
  }
  [[nodiscard]] std::uint64_t plan_bytes() const override { return plan_.bytes(); }
  [[nodiscard]] std::uint64_t worker_bytes() const override {
    return SparseExtractor::scratch_bytes();
  }
  [[nodiscard]] std::uint64_t max_mesh_bytes(std::size_t n_blocks) const override {
    return SparseExtractor::most_bytes_of(n_blocks, plan_.options());
  }
  /// A cell's edges, each of four cells, make two triangles fewer.
  [[nodiscard]] std::uint64_t max_triangles_per_vertex() const override { return 4; }

 private:
  SparsePlan plan_;
  Affine to_world_;
};

}  // namespace mc::extraction
