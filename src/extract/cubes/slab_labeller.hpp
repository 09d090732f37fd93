// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "extract/components/run_table.hpp"
#include "extract/cubes/dense_grid.hpp"
#include "extract/cubes/size_sums.hpp"
#include "mc/field.hpp"

namespace mc::extraction {

/// The options by which components are told apart and measured: components that an open border
/// cuts are closed there, so that each has a volume.
[[nodiscard]] ExtractOptions labelling_options(const ExtractOptions& options);

/// Labels the solid runs in slabs of a dense volume and measures the surface there. Keeps scratch:
/// one to a thread.
class SlabLabeller {
 public:
  /// `options` are those of the surface.
  SlabLabeller(const Volume& volume, const Affine& to_world, const ExtractOptions& options,
               SizeKind kind);

  /// Layers of cells, those to the constant layer included.
  [[nodiscard]] std::int32_t n_layers() const { return grid_.n_layers; }
  /// Index along k of the first plane.
  [[nodiscard]] std::int32_t first_plane() const { return grid_.classifier.first_of(0)[2]; }
  /// The volume's planes that layers [l0, l1) need.
  [[nodiscard]] std::pair<std::int32_t, std::int32_t> planes_for(std::int32_t l0,
                                                                 std::int32_t l1) const {
    return grid_.planes_for(l0, l1);
  }
  [[nodiscard]] const SizeUnit& unit() const { return unit_; }
  /// Bytes of scratch and labels for so many layers at most, whatever the samples are.
  [[nodiscard]] std::uint64_t max_bytes(std::int32_t n_layers) const;

  /// Labels the planes between which layers [l0, l1) lie.
  void label(const Slab& slab, std::int32_t l0, std::int32_t l1, SlabLabels& out);

 private:
  void join_rows(std::size_t plane, std::size_t j, SlabLabels& labels) const;
  template <class T, bool Swap>
  void measure(const Slab& slab, std::int32_t l0, SlabLabels& out);
  template <class Vertices>
  void measure_row(const Vertices& vertices, std::int32_t layer, std::size_t p, std::size_t j,
                   const SlabLabels& labels);

  DenseGrid grid_;
  Border border_;  ///< of the surface
  SizeUnit unit_;
  std::vector<PlaneBits> bits_;
  std::vector<PlaneRuns> runs_;
  std::vector<std::uint32_t> number_;  ///< of each root among the roots
  std::vector<std::uint64_t> sums_;    ///< of each root
};

}  // namespace mc::extraction
