// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "extract/bits/shared_planes.hpp"
#include "extract/cubes/dense_grid.hpp"
#include "extract/cubes/surface_sums.hpp"
#include "extract/cubes/vertex_pass.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"
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
class DenseExtractor {
 public:
  explicit DenseExtractor(DenseGrid grid);
  DenseExtractor(const Volume& volume, const Affine& to_world, const ExtractOptions& options)
      : DenseExtractor(DenseGrid(volume, to_world, options)) {}
  /// Starts with a part.
  DenseExtractor(const Volume& volume, const Affine& to_world, const ExtractOptions& options,
                 const IndexBox& part)
      : DenseExtractor(DenseGrid(volume, to_world, options, part)) {}

  /// As DenseGrid's. Allocates nothing where an earlier part had the same size.
  void set_part(const IndexBox& part);
  /// All samples that cells lie between, those of a closed border's constant layer included.
  [[nodiscard]] IndexBox whole() const { return grid_.classifier.whole(); }
  /// The samples that the part is made of: its own and those that its normals look at.
  [[nodiscard]] const IndexBox& samples() const { return grid_.classifier.box(); }
  /// Layers of cells, those to a closed border included.
  [[nodiscard]] std::int32_t n_layers() const { return grid_.n_layers; }

  /// Bytes of scratch.
  static std::uint64_t scratch_bytes(const DenseGrid& grid);

  /// Lets slabs of one run classify the planes between them once. `planes` must outlive the run.
  void share(SharedPlanes* planes) { shared_ = planes; }

  /// Makes the surface of layers from l0 up to l1, or up to the layer with which `chunk` would hold
  /// more than `most_bytes`: of that there is nothing in it. `slab` holds at least the planes of
  /// DenseGrid::planes_for(), of these the rows and columns of samples(). Indices in `chunk` count
  /// from the slab's first vertex. Returns the layer after the last; where that is l0, the vertices
  /// in plane l0 are not made either.
  std::int32_t extract(const Slab& slab, std::int32_t l0, std::int32_t l1, std::uint64_t most_bytes,
                       MeshChunk& chunk, TaskTotals& totals);
  /// Makes all of layers [l0, l1).
  void extract(const Slab& slab, std::int32_t l0, std::int32_t l1, MeshChunk& chunk,
               TaskTotals& totals) {
    extract(slab, l0, l1, mesh::ChunkRoom::kUnlimited, chunk, totals);
  }
  /// Only counts.
  void count(const Slab& slab, std::int32_t l0, std::int32_t l1, TaskTotals& totals);
  /// Counts the vertices of layers [l0, l1), and those in plane l0 only if `with_lowest`.
  std::uint64_t count_vertices(const Slab& slab, std::int32_t l0, std::int32_t l1,
                               bool with_lowest);

 private:
  static constexpr std::int32_t kNoPlane = -1;

  PlaneBits& bits(std::int32_t plane) { return planes_[static_cast<std::size_t>(plane) % 3]; }
  BitPlane view(std::int32_t plane) { return grid_.classifier.view(bits(plane)); }
  [[nodiscard]] bool owns(std::int32_t plane, std::int32_t l1) const {
    return plane < l1 || l1 == grid_.n_layers;
  }
  void shape();
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
                             mesh::ChunkRoom& room, TaskTotals& totals);

  DenseGrid grid_;
  SharedPlanes* shared_ = nullptr;
  std::array<PlaneBits, 3> planes_;
  std::vector<std::uint32_t> k_start_;
  EdgeBatches batches_;
};

}  // namespace mc::extraction
