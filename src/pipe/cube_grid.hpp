// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "mc/field.hpp"
#include "mc/mesh.hpp"

// How the lattice of a volume is cut into the cubes of cube stages.

namespace mc::pipe {

class CubeGrid {
 public:
  /// `samples` are those that the mesh lies between; empty if there is no end. Cubes start at the
  /// lowest of them or, unless `at_lowest`, at multiples of n_cells. Positions are what `to_world`
  /// makes of lattice coordinates, less `origin`.
  /// Errors   input: a map that cannot be inverted.
  CubeGrid(const IndexBox& samples, const Affine& to_world, const Vec3& origin,
           std::int32_t n_cells, bool at_lowest);

  /// The cube that a position lies in, in the first or the second pass. What lies outside the
  /// samples, as a closed border does, belongs to the cube next to it.
  [[nodiscard]] Index3 cube_of(const Vec3& position, bool shifted) const;
  /// Cube root of a cell's volume, in world units.
  [[nodiscard]] double cell() const { return cell_; }

 private:
  Affine to_cubes_;                ///< from positions to cubes of the first pass
  std::array<IndexBox, 2> cubes_;  ///< of the first pass and of the second
  double cell_;
};

}  // namespace mc::pipe
