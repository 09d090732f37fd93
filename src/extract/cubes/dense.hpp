// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "extract/bits/shared_planes.hpp"
#include "extract/cubes/dense_grid.hpp"
#include "extract/cubes/vertex_pass.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"
#include "mc/method.hpp"
#include "mesh/chunk_room.hpp"

// Flying Edges over dense slabs (Schroeder, Maynard, Geveci, LDAV 2015), with one bit a sample
// instead of a case a cell: plane by plane the samples are classified to bits, the crossed edges
// counted and numbered, their vertices made, and the layer's triangles written, while its planes
// are in cache.
//
// Order of vertices: plane by plane; in a plane row by row, i-edges before j-edges; then the
// k-edges to the next plane. A slab owns the vertices from its lowest plane up to, and not
// including, its highest, which come first in the slab above: so their ids follow its own without a
// gap, and ids do not depend on where slabs are cut.

namespace mc::extraction {

/// Extracts slabs of one volume with one set of options, or of parts of it, one after the other.
/// Holds scratch: one to a thread.
class DenseExtractor final : public SlabEngine {
 public:
  explicit DenseExtractor(DenseGrid grid);
  DenseExtractor(const Volume& volume, const Affine& to_world, const ExtractOptions& options)
      : DenseExtractor(DenseGrid(volume, to_world, options)) {}
  /// Starts with a part.
  DenseExtractor(const Volume& volume, const Affine& to_world, const ExtractOptions& options,
                 const IndexBox& part)
      : DenseExtractor(DenseGrid(volume, to_world, options, part)) {}

  /// All samples that cells lie between, those of a closed border's constant layer included.
  [[nodiscard]] IndexBox whole() const { return grid_.classifier.whole(); }

  /// Layers of cells, those to a closed border included.
  [[nodiscard]] std::int32_t n_layers() const override { return grid_.n_layers; }
  [[nodiscard]] std::int32_t max_layers() const override { return grid_.max_layers(); }
  [[nodiscard]] std::pair<std::int32_t, std::int32_t> planes_for(std::int32_t l0,
                                                                 std::int32_t l1) const override {
    return grid_.planes_for(l0, l1);
  }
  [[nodiscard]] std::uint64_t scratch_bytes() const override;
  [[nodiscard]] std::uint64_t max_mesh_bytes(std::int32_t n_layers) const override;
  [[nodiscard]] std::uint64_t least_chunk_bytes() const override;
  [[nodiscard]] bool has_bands() const override { return true; }
  [[nodiscard]] std::unique_ptr<SlabBands> bands(std::size_t n_makers) const override;
  [[nodiscard]] std::uint64_t bands_bytes(std::size_t n_makers) const override;
  /// Slabs of one run then classify the planes between them once.
  void share(std::span<SlabEngine* const> others) override;
  void forget() override { own_shared_.forget(); }
  void set_box(const IndexBox& cells) override;
  [[nodiscard]] IndexBox samples() const override { return grid_.classifier.box(); }

  std::int32_t extract(const Slab& slab, std::int32_t l0, std::int32_t l1, std::uint64_t max_bytes,
                       MeshChunk& chunk, SurfaceTotals& totals) override;
  /// Makes all of layers [l0, l1).
  void extract(const Slab& slab, std::int32_t l0, std::int32_t l1, MeshChunk& chunk,
               SurfaceTotals& totals) {
    extract(slab, l0, l1, mesh::ChunkRoom::kUnlimited, chunk, totals);
  }
  void count(const Slab& slab, std::int32_t l0, std::int32_t l1, SurfaceTotals& totals) override;
  std::uint64_t count_vertices(const Slab& slab, std::int32_t l0, std::int32_t l1,
                               bool with_lowest) override;

 private:
  static constexpr std::int32_t kNoPlane = -1;

  PlaneBits& bits(std::int32_t plane) { return planes_[static_cast<std::size_t>(plane) % 3]; }
  BitPlane view(std::int32_t plane) { return grid_.classifier.view(bits(plane)); }
  [[nodiscard]] bool owns(std::int32_t plane, std::int32_t l1) const {
    return plane < l1 || l1 == grid_.n_layers;
  }
  void shape_planes();
  void load(const Slab& slab, std::int32_t plane, SharedPlanes* shared);

  template <class Pass>
  std::uint32_t write_plane_of(std::int32_t plane, std::uint32_t next, Pass& pass);
  template <class Pass>
  std::uint32_t write_above(std::int32_t layer, const Slab& slab, std::int32_t coming,
                            std::uint32_t next, Pass& pass);
  template <class Pass>
  void emit_layer(std::int32_t layer, mesh::ChunkRoom& room, Pass& pass);
  template <class Pass>
  std::uint32_t make_layer(const Slab& slab, std::int32_t layer, std::int32_t l1,
                           std::uint32_t next, mesh::ChunkRoom& room, Pass& pass);
  template <class T, bool Swap>
  std::int32_t extract_typed(const Slab& slab, std::int32_t l0, std::int32_t l1,
                             mesh::ChunkRoom& room, SurfaceTotals& totals);

  DenseGrid grid_;
  SharedPlanes own_shared_;         ///< of a run whose engines share with this one
  SharedPlanes* shared_ = nullptr;  ///< another engine's
  bool shaped_ = false;             ///< whether the planes have the shape of the grid
  std::array<PlaneBits, 3> planes_;
  std::vector<std::uint32_t> k_start_;
  EdgeBatches batches_;
};

}  // namespace mc::extraction
