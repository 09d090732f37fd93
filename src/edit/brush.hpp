// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "edit/block.hpp"
#include "mc/edit.hpp"

// What an edit's brush is, once for all places where it works: a shape in a frame of its own, and a
// list of positions.

namespace mc::edit {

/// Shapes as they are measured. Balls are spheres, capsules, and what either sweeps.
enum class Form : std::uint8_t { ball, box, cylinder, cone, ellipsoid, plane, node, everywhere };

/// What all positions of a brush share. Lengths are the world's; the frame's y is a cylinder's
/// axis.
struct Brush {
  Form form = Form::ball;
  /// Half sizes without rounding (box); radius, half height (cylinder); the radii below and above,
  /// half height (cone); radii (ellipsoid); half sizes of the bounds (node).
  Vec3 half{};
  Vec3 middle{};        ///< node: of its bounds
  double rounding = 0;  ///< box, cylinder
  double inradius = 0;  ///< radius of the largest ball inside; balls have their own
  double reach = 0;     ///< the brush works where the signed distance is at most this
  Falloff falloff{};
  const GraphField* node = nullptr;
};

/// Where a brush is: at one point, or anywhere on a line from the frame's origin.
/// Balls have radius - taper s at s along the line.
struct Position {
  Affine to_local;  ///< from sample indices to the brush's frame
  IndexBox box;     ///< no sample outside it can be reached; clipped to the volume
  Vec3 along{};     ///< unit length
  double length = 0;
  double radius = 0;
  double taper = 0;
  double slope = 0;         ///< taper / sqrt(1 - taper^2): how the nearest ball lies off the foot
  Affine to_stamp{};        ///< from sample indices to those of the stamp
  std::uint32_t group = 0;  ///< positions of one group are one place: the nearest counts
};

/// A brush and all its positions, in the order in which they work.
struct Stroke {
  Brush brush;
  std::vector<Position> positions;
  std::uint32_t n_groups = 0;
  std::uint64_t n_outside = 0;  ///< groups that cannot reach any sample
};

/// The inverse of an affine map. Precondition: it has one.
[[nodiscard]] Affine inverse(const Affine& map);

/// Positions of dabs and copies by symmetry are groups of their own; those of a sweep are one
/// group for each copy.
/// `within`: samples there are; `bounded`: the same, but not endless (for planes).
/// Errors   limit: more than kMostPositions.
Stroke lay_out(const Edit& edit, const EditRules& rules, const IndexBox& within,
               const IndexBox& bounded);
inline constexpr std::size_t kMostPositions = std::size_t{1} << 20U;

using Row = std::array<double, kBlockSize>;

/// Coordinates of eight samples of a row.
struct Places {
  alignas(64) Row x, y, z;
};
/// Of eight samples: the signed distance (negative inside), the distance from the brush's middle as
/// falloffs take it, and the radius that belongs to it.
struct Distances {
  alignas(64) Row sd, r, radius;
};

/// The places of samples i0 .. i0 + 7 of row (j, k): m0 i + ((m1 j + m2 k) + m3), and so on.
void place_row(const Affine& map, std::int32_t i0, std::int32_t j, std::int32_t k,
               Places& out) noexcept;
/// `node`: eight values of the node, if the brush is one.
void measure_row(const Brush& brush, const Position& at, Places& places, const float* node,
                 Distances& out) noexcept;
/// A weight in [0, 1] each; 0 wherever the brush does not reach.
void weigh_row(const Brush& brush, const Distances& distances, Row& out) noexcept;

/// Whether no sample of the box can be reached. Says no where it is not sure.
[[nodiscard]] bool misses(const Brush& brush, const Position& at, const IndexBox& box) noexcept;

}  // namespace mc::edit
