// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
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

  /// The lattice coordinates of a position, in cubes of the first pass.
  [[nodiscard]] Vec3 in_cubes(const Vec3& position) const {
    const std::array<double, 12>& m = to_cubes_.m;
    const auto [x, y, z] = position;
    return {((m[0] * x + m[1] * y) + m[2] * z) + m[3], ((m[4] * x + m[5] * y) + m[6] * z) + m[7],
            ((m[8] * x + m[9] * y) + m[10] * z) + m[11]};
  }
  /// The cube with these coordinates, in the first or the second pass. What lies outside the
  /// samples, as a closed border does, belongs to the cube next to it.
  [[nodiscard]] Index3 cube_at(const Vec3& in_cubes, bool shifted) const {
    const IndexBox& cubes = cubes_[shifted ? 1 : 0];
    Index3 cube;
    for (std::size_t a = 0; a < 3; ++a) {
      const double at = in_cubes[a] + (shifted ? 0.5 : 0.0);
      // The comparison puts what is not a number into the lowest cube.
      const double inside = at > cubes.lo[a] ? std::min(at, double(cubes.hi[a])) : cubes.lo[a];
      const auto truncated = static_cast<std::int32_t>(inside);
      cube[a] = truncated - (inside < truncated ? 1 : 0);
    }
    return cube;
  }
  [[nodiscard]] Index3 cube_of(const Vec3& position, bool shifted) const {
    return cube_at(in_cubes(position), shifted);
  }
  /// Cube root of a cell's volume, in world units.
  [[nodiscard]] double cell() const { return cell_; }

 private:
  Affine to_cubes_;                ///< from positions to cubes of the first pass
  std::array<IndexBox, 2> cubes_;  ///< of the first pass and of the second
  double cell_;
};

}  // namespace mc::pipe
