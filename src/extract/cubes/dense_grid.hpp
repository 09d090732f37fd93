// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "extract/bits/plane_bits.hpp"
#include "extract/components/selection.hpp"
#include "extract/cubes/edge_vertex.hpp"
#include "extract/cubes/surface_sums.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"

// What stays the same through the extraction of one dense volume, or of a part of it.

namespace mc::extraction {

struct DenseGrid {
  /// Errors: limit, where one layer could hold more vertices than 32-bit ids can name.
  DenseGrid(const Volume& volume, const Affine& map, const ExtractOptions& how)
      : DenseGrid(volume, map, how, PlaneClassifier(volume, how).whole()) {}
  /// Starts with a part.
  DenseGrid(const Volume& volume, const Affine& map, const ExtractOptions& how,
            const IndexBox& part);
  /// From now on there are only the cells between these samples of classifier.whole(), as they are
  /// in the surface of all, with its vertices and normals. Layers count from the part's lowest
  /// sample. Errors: as the constructor's.
  void set_part(const IndexBox& part);

  [[nodiscard]] std::int32_t n_planes() const { return n_layers + 1; }
  /// Most layers that one slab may have for its ids to fit 32 bits.
  [[nodiscard]] std::int32_t max_layers() const;
  /// The volume's planes [first, second) that layers [l0, l1) need.
  [[nodiscard]] std::pair<std::int32_t, std::int32_t> planes_for(std::int32_t l0,
                                                                 std::int32_t l1) const;
  /// Planes that gradients look at beyond those of a layer: their bits are made that much earlier.
  [[nodiscard]] std::int32_t reach() const { return options.normals == Normals::gradient ? 1 : 0; }
  [[nodiscard]] std::uint64_t border_sides(const PlaneBits& lower, const PlaneBits& upper,
                                           std::int32_t layer) const {
    return classifier.border_sides(lower, upper, layer == 0, layer + 1 == n_layers);
  }
  /// Makes components that are left out not solid, once all rows of a plane are classified.
  void select(std::int32_t plane, PlaneBits& bits) const {
    if (options.selection == nullptr) return;
    options.selection->dense().apply(classifier.first_of(plane)[2], classifier.view(bits),
                                     bits.words.data());
  }
  /// Area and volume of the surface in one layer.
  template <class Vertices>
  [[nodiscard]] LayerSum measure(const BitPlane& lower, const BitPlane& upper, std::int32_t layer,
                                 const Vertices& vertices) const;

  std::string name;  ///< of the volume
  Affine to_world;
  ExtractOptions options;
  Placement placement;
  PlaneClassifier classifier;
  Vec3 apex;                  ///< volumes are summed from here, in lattice units
  std::int32_t n_layers = 0;  ///< of cells, those to a closed border included
};

template <class Vertices>
LayerSum DenseGrid::measure(const BitPlane& lower, const BitPlane& upper, std::int32_t layer,
                            const Vertices& vertices) const {
  const Index3 first = classifier.first_of(layer);
  LayerSum sum;
  for (std::size_t j = 0; j + 1 < lower.n_rows; ++j) {
    for (std::size_t w = 0; w < lower.words_per_row; ++w) {
      const CellWords words(lower, upper, j, w);
      for_each_bit(words.active() & lower.cells[w], [&](int bit) {
        const Index3 cell{first[0] + index_in_row(w, bit), first[1] + static_cast<std::int32_t>(j),
                          first[2]};
        add_cell(vertices, placement, cell, kCases[words.case_at(bit)], apex, sum);
      });
    }
  }
  return sum;
}

}  // namespace mc::extraction
