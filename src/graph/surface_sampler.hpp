// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "graph/bounds.hpp"
#include "graph/machine.hpp"
#include "graph/program.hpp"
#include "graph/prune.hpp"
#include "graph/row_range.hpp"
#include "mc/field.hpp"

namespace mc::graph {

/// Where indices of the lattice lie.
struct WorldGrid {
  Vec3 origin, spacing;

  [[nodiscard]] float at(std::size_t axis, std::int64_t index) const {
    return world_at(origin[axis], spacing[axis], index);
  }
  /// All coordinates of indices lo to hi: rounding is monotone.
  [[nodiscard]] Interval range(std::size_t axis, std::int64_t lo, std::int64_t hi) const;
};

/// Samples a field near its surface; see GraphField::sample_surface(). Goes through the lattice in
/// columns along y. What does not depend on y is computed first, and so its range is known exactly.
/// Then the column is halved until a part is proven to lie on one side, with all samples up to two
/// steps from it, or is small enough to be sampled; each half has a shorter program of its own.
class SurfaceSampler {
 public:
  /// `out` begins at the lattice's index `first` and holds all of `box`, which is the part of the
  /// query's region to be sampled.
  SurfaceSampler(const Program& program, const WorldGrid& grid, const SurfaceQuery& query,
                 const IndexBox& box, const Index3& first, const View3<float>& out, SideMap& sides);

  void run();

 private:
  enum class Side : std::uint8_t { both, above, below };

  void take_column(const IndexBox& column);
  void divide(const IndexBox& part, std::span<const Instruction> code, std::size_t depth);
  void compute(const IndexBox& part, std::span<const Instruction> code);
  void leave_out(const IndexBox& part, bool above);
  void write_faces(const IndexBox& part, float value);
  Side bound(const IndexBox& part, std::span<const Instruction> code);
  void run_flat(const IndexBox& column, std::span<const Instruction> flat);
  void run_places(std::size_t n, std::span<const Instruction> flat);
  void find_edges(std::span<const Instruction> deep);
  [[nodiscard]] float* sample_at(std::int32_t i, std::int32_t j, std::int32_t k) const;

  const Program& program_;
  const WorldGrid grid_;
  const SurfaceQuery& query_;
  const float iso_;
  const IndexBox box_;
  const Index3 first_;
  const View3<float> out_;
  SideMap& sides_;

  Machine machine_;
  Pruner pruner_;
  std::vector<Interval> bounds_;                ///< of values, over the part that was bounded last
  std::vector<std::vector<Instruction>> code_;  ///< pruned programs, for each depth of halving
  std::vector<Value> edges_;                    ///< flat values that the deep code looks at,
  std::vector<RowRange> ranges_;                ///< and what they are in this column
};

}  // namespace mc::graph
