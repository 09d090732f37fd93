// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "mc/edit.hpp"

namespace mc::edit {

/// A piece of a path, or a point; in the world.
struct Stretch {
  Vec3 from{};
  Vec3 to{};
  double radius = 0;
  double end_radius = 0;
};

/// Whether a shape is a ball, or balls along a line.
[[nodiscard]] bool is_hull(ShapeType type);

/// Where an edit's brush goes: the points of its dabs, the pieces of its sweep, or its own place.
/// Dabs start with the path, each `spacing` times the radius there after the one before; a tapering
/// radius counts at least a sixteenth of the larger end's.
/// Errors   limit: more than kMostPositions dabs.
std::vector<Stretch> stretches(const Edit& edit, double inradius);

/// Errors   limit, always.
[[noreturn]] void refuse_positions();

}  // namespace mc::edit
