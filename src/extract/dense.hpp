// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "extract/plane_bits.hpp"
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

/// Extracts slabs of one volume with one set of options, or of parts of it, one after the other.
/// Holds scratch: one to a thread.
class DenseExtractor {
 public:
  /// Errors: limit, where one layer could hold more vertices than 32-bit ids can name.
  DenseExtractor(const Volume& volume, const Affine& to_world, const ExtractOptions& options);
  /// Starts with a part.
  DenseExtractor(const Volume& volume, const Affine& to_world, const ExtractOptions& options,
                 const IndexBox& part);

  /// From now on makes only the cells between these samples of whole(): as they are in the surface
  /// of all, with its vertices and normals. Layers and ids count from the part's lowest sample.
  /// Errors: as the constructor's. Allocates nothing where an earlier part had the same size.
  void set_part(const IndexBox& part);
  /// All samples that cells lie between, those of a closed border's constant layer included.
  [[nodiscard]] IndexBox whole() const { return classifier_.whole(); }
  /// The samples that the part is made of: its own and those that its normals look at.
  [[nodiscard]] const IndexBox& samples() const { return classifier_.box(); }

  /// Layers of cells, those to a closed border included.
  [[nodiscard]] std::int32_t n_layers() const { return n_layers_; }
  /// Most layers that one slab may have for its ids to fit 32 bits.
  [[nodiscard]] std::int32_t max_layers() const;
  /// The volume's planes [first, second) that layers [l0, l1) need.
  [[nodiscard]] std::pair<std::int32_t, std::int32_t> planes_for(std::int32_t l0,
                                                                 std::int32_t l1) const;
  /// Bytes of scratch.
  [[nodiscard]] std::uint64_t scratch_bytes() const;

  /// Lets slabs of one run classify the planes between them once. `planes` must outlive the run.
  void share(SharedPlanes* planes) { shared_ = planes; }

  /// Makes the surface of layers [l0, l1). `slab` holds at least the planes of planes_for(), of
  /// these the rows and columns of samples(). Indices in `chunk` count from the slab's first
  /// vertex.
  void extract(const Slab& slab, std::int32_t l0, std::int32_t l1, MeshChunk& chunk,
               TaskTotals& totals);
  /// Only counts.
  void count(const Slab& slab, std::int32_t l0, std::int32_t l1, TaskTotals& totals);

 private:
  template <class T, bool Swap>
  struct VertexPass;
  static constexpr std::int32_t kNoPlane = -1;

  [[nodiscard]] std::int32_t n_planes() const { return n_layers_ + 1; }
  /// Planes that gradients look at beyond those of a layer: their bits are made that much earlier.
  [[nodiscard]] std::int32_t reach() const { return options_.normals == Normals::gradient ? 1 : 0; }
  PlaneBits& bits(std::int32_t plane) { return planes_[static_cast<std::size_t>(plane) % 3]; }
  [[nodiscard]] const PlaneBits& bits(std::int32_t plane) const {
    return planes_[static_cast<std::size_t>(plane) % 3];
  }
  void load(const Slab& slab, std::int32_t plane, bool is_shared);
  [[nodiscard]] std::uint64_t border_sides(std::int32_t layer) const;

  template <class Pass>
  std::uint32_t write_plane(std::int32_t plane, std::uint32_t next, Pass& pass);
  template <class Pass>
  std::uint32_t write_between(std::int32_t layer, const Slab& slab, std::int32_t coming,
                              std::uint32_t next, Pass& pass);
  void emit_layer(std::int32_t layer, MeshChunk& chunk);
  template <class Vertices>
  [[nodiscard]] LayerSum measure(std::int32_t layer, const Vertices& vertices) const;
  template <class T, bool Swap>
  void extract_typed(const Slab& slab, std::int32_t l0, std::int32_t l1, MeshChunk& chunk,
                     TaskTotals& totals);

  std::string name_;
  Affine to_world_;
  ExtractOptions options_;
  Placement placement_;
  PlaneClassifier classifier_;
  Vec3 apex_;  ///< volumes are summed from here, in lattice units
  std::int32_t n_layers_ = 0;
  SharedPlanes* shared_ = nullptr;
  std::array<PlaneBits, 3> planes_;
  std::vector<std::uint32_t> k_start_;
  std::tuple<EdgeBatch<float>, EdgeBatch<double>> batches_;
};

}  // namespace mc::extraction
