// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "extract/components/run_table.hpp"
#include "extract/components/selection.hpp"
#include "extract/cubes/size_sums.hpp"
#include "extract/sparse/solid_cells.hpp"
#include "extract/sparse/sparse_plan.hpp"

// The components of a sparse volume. Solid samples are joined at two levels by the same word
// arithmetic: runs of samples in blocks that have both kinds, and runs of blocks, in nodes of 8x8x8
// blocks, that are solid throughout. Tiles of whole nodes, and nodes where only background is, are
// joined as a whole. Nothing is densified.

namespace mc::extraction {

class SparseComponents {
 public:
  /// Joins everything that is connected. `options` are those of the surface.
  /// Errors   limit: more runs than 32-bit numbers can name, or background that is solid and
  /// reaches
  ///          too far.
  SparseComponents(const LeafReader& reader, const Affine& to_world, const ExtractOptions& options,
                   SizeKind kind);

  /// Adds up the sizes of the components in surface blocks [first, last) of n_blocks().
  /// Threads  several at once.
  void measure(std::size_t first, std::size_t last, std::vector<RunSize>& out) const;
  [[nodiscard]] std::size_t n_blocks() const { return plan_.n_own(); }
  /// Takes what measure() made, in any order.
  void add(std::span<const RunSize> sizes);

  /// Sizes of the components, ordered by their first sample in (z, y, x); infinite if a component
  /// reaches past all that is stored. Call after all sizes are added.
  [[nodiscard]] std::vector<double> sizes() const;
  /// What to leave out, by a 1 for each component that remains.
  [[nodiscard]] SparseSelection selection(std::span<const std::uint8_t> kept) const;
  [[nodiscard]] std::uint64_t bytes() const;

 private:
  static constexpr std::uint32_t kNone = CellJoiner::kNone;

  void list_blocks();
  void list_nodes();
  void list_background();
  void number_runs(SolidCells& cells);
  void join_tiles();
  void join_background();
  void number_components();
  [[nodiscard]] std::uint32_t block_number(const Index3& block) const;
  [[nodiscard]] std::uint32_t node_number(const Index3& node) const;
  [[nodiscard]] Index3 background_node(std::uint32_t number) const;
  [[nodiscard]] bool is_solid_outside() const;
  [[nodiscard]] bool touches_box(const Index3& lo, const Index3& hi) const;
  template <class T>
  void measure_typed(std::size_t first, std::size_t last, std::vector<RunSize>& out) const;

  const LeafReader& reader_;
  Affine to_world_;
  ExtractOptions options_;  ///< for labelling
  Border border_;           ///< of the surface
  SparsePlan plan_;
  Placement placement_;
  SizeUnit unit_;
  bool solid_above_;
  CellJoiner joiner_;
  SolidCells blocks_, nodes_;
  std::vector<BlockIndex::UniformNodes> tiles_;
  std::uint32_t first_tile_ = 0;
  std::optional<IndexBox> background_;  ///< nodes, if background is solid
  std::uint32_t first_background_ = 0;
  std::uint32_t outside_ = 0;          ///< all that lies beyond; the last number
  std::vector<std::uint32_t> parent_;  ///< of each number; later its component
  std::vector<std::uint64_t> sums_;    ///< of each component
  std::uint32_t unbounded_ = kNone;    ///< the component that reaches past all that is stored
};

}  // namespace mc::extraction
