// SPDX-License-Identifier: MIT
#include "pipe/cube_grid.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace mc::pipe {

namespace {

/// Cubes of a sparse volume: indices of samples have 32 bits, and cubes at least two cells.
constexpr std::int32_t kMaxCube = 1 << 30;

std::int32_t floor_of(std::int64_t number, std::int32_t divisor) {
  const std::int64_t quotient = number / divisor;
  return static_cast<std::int32_t>(quotient - (number % divisor < 0 ? 1 : 0));
}

/// The map from positions relative to `origin` to lattice coordinates in units of n_cells.
Affine cubes_of(const Affine& to_world, const Vec3& origin, const Index3& first_sample,
                std::int32_t n_cells) {
  const std::optional<Affine> inverse = to_world.inverse();
  if (!inverse) {
    throw Error(ErrorKind::input, "",
                "cubes of cells need a map from samples to the world that can be inverted");
  }
  Affine out = *inverse;
  const Vec3 at_origin = out(origin);
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t c = 0; c < 3; ++c) out.m[4 * a + c] /= n_cells;
    out.m[4 * a + 3] = (at_origin[a] - first_sample[a]) / n_cells;
  }
  return out;
}

}  // namespace

CubeGrid::CubeGrid(const IndexBox& samples, const Affine& to_world, const Vec3& origin,
                   std::int32_t n_cells, bool at_lowest)
    : to_cubes_(cubes_of(to_world, origin, at_lowest ? samples.lo : Index3{}, n_cells)),
      cell_(std::cbrt(std::abs(to_world.determinant()))) {
  for (const bool shifted : {false, true}) {
    IndexBox& cubes = cubes_[shifted ? 1 : 0];
    cubes = {{-kMaxCube, -kMaxCube, -kMaxCube}, {kMaxCube, kMaxCube, kMaxCube}};
    if (is_empty(samples)) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t before = (at_lowest ? samples.lo[a] : 0) - (shifted ? n_cells / 2 : 0);
      cubes.lo[a] = floor_of(samples.lo[a] - before, n_cells);
      cubes.hi[a] =
          floor_of(std::max<std::int64_t>(samples.lo[a], samples.hi[a] - 1) - before, n_cells);
    }
  }
}

}  // namespace mc::pipe
