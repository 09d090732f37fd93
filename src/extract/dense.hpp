// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "extract/row_kernels.hpp"
#include "extract/shared_planes.hpp"
#include "extract/surface_sums.hpp"
#include "extract/vertex_writer.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"

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

/// Extracts slabs of one volume with one set of options. Holds scratch: one to a thread.
class DenseExtractor {
 public:
  /// Errors: limit, where one layer could hold more vertices than 32-bit ids can name.
  DenseExtractor(const Volume& volume, const Affine& to_world, const ExtractOptions& options);

  /// Layers of cells, those to a closed border included.
  [[nodiscard]] std::int32_t n_layers() const { return n_planes_ - 1; }
  /// Most layers that one slab may have for its ids to fit 32 bits.
  [[nodiscard]] std::int32_t max_layers() const;
  /// The volume's planes [first, second) that layers [l0, l1) need.
  [[nodiscard]] std::pair<std::int32_t, std::int32_t> planes_for(std::int32_t l0,
                                                                 std::int32_t l1) const;
  /// Bytes of scratch.
  [[nodiscard]] std::uint64_t scratch_bytes() const;

  /// Lets slabs of one run classify the planes between them once. `planes` must outlive the run.
  void share(SharedPlanes* planes) { shared_ = planes; }

  /// Makes the surface of layers [l0, l1). `slab` holds at least the planes of planes_for().
  /// Indices in `chunk` count from the slab's first vertex.
  void extract(const Slab& slab, std::int32_t l0, std::int32_t l1, MeshChunk& chunk,
               TaskTotals& totals);
  /// Only counts.
  void count(const Slab& slab, std::int32_t l0, std::int32_t l1, TaskTotals& totals);

 private:
  /// Bits of one plane and the first ids of its rows.
  struct Plane {
    Buffer<std::uint64_t> words;
    std::vector<std::uint32_t> i_start, j_start;
    std::vector<std::uint64_t> first_column, last_column;  ///< the rows' ends, as rows
  };

  [[nodiscard]] BitPlane bits(const Plane& plane) const;
  [[nodiscard]] static PlaneIds ids(Plane& plane);
  [[nodiscard]] CellLayer layer();
  [[nodiscard]] std::int32_t pad() const { return capped_ ? 1 : 0; }
  void classify(const Slab& slab, std::int32_t plane, Plane& out) const;
  void take_columns(Plane& plane) const;
  void load(const Slab& slab, std::int32_t plane, bool is_shared, Plane& out);
  void pad_row(std::uint64_t* row) const;
  void emit_layer(MeshChunk& chunk);
  [[nodiscard]] std::uint64_t boundary_edges(std::int32_t layer) const;
  template <class T, bool Swap>
  void extract_typed(const Slab& slab, std::int32_t l0, std::int32_t l1, MeshChunk& chunk,
                     TaskTotals& totals);
  template <class T, bool Swap>
  struct VertexPass;
  template <class Pass>
  std::uint32_t write_plane(Plane& plane, std::int32_t p, std::uint32_t next, Pass& pass) const;
  template <class Pass>
  std::uint32_t write_between(std::int32_t p, std::uint32_t next, Pass& pass);
  template <class Vertices>
  [[nodiscard]] LayerSum measure(std::int32_t p, const Vertices& vertices) const;

  SampleType type_;
  Affine to_world_;
  ExtractOptions options_;
  Placement placement_;
  IndexBox box_;  ///< the region
  Vec3 apex_;     ///< volumes are summed from here, in lattice units
  Threshold threshold_;
  bool capped_;
  bool above_outside_;  ///< the constant layer of a closed border
  std::size_t row_samples_, n_rows_, n_words_;
  std::int32_t n_planes_;
  Buffer<std::uint64_t> cells_;              ///< ones for the cells of a row
  std::vector<std::uint64_t> column_cells_;  ///< and of a column
  SharedPlanes* shared_ = nullptr;
  Plane lower_, upper_;
  std::vector<std::uint32_t> k_start_;
  std::tuple<EdgeBatch<float>, EdgeBatch<double>> batches_;
};

}  // namespace mc::extraction
