// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "mc/convert.hpp"

// Where a mesh lies in its file, and at which precision: the source's frame and units against what
// the format and the caller want.

namespace mc::conversion {

/// What rounding stored positions does to vertices.
struct RoundingLoss {
  double largest_move = 0;  ///< world units, at most; infinity where positions overflow
  bool matters = false;     ///< more than 1/8192 of the smallest cell spacing
  bool collapses = false;   ///< more than 1/8: neighbouring vertices may become one
};

/// Rounding of positions anywhere in `box` under `to_world`.
RoundingLoss rounding_loss(const IndexBox& box, const Affine& to_world, Precision precision);

/// Refuses a mesh whose vertices could coincide. Errors   limit; usage, where the caller `asked`
/// for the map.
void check_told_apart(const std::string& place, const IndexBox& box, const Affine& to_world,
                      const MeshNeeds& needs, bool asked);

/// The middle of the box: positions relative to it are small.
Vec3 double_origin(const IndexBox& box, const Affine& to_world);

}  // namespace mc::conversion
