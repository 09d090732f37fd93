// SPDX-License-Identifier: MIT
#pragma once

#include "mc/process.hpp"

// Windows from and to the chunks of a run.

namespace mc::process {

/// Drops the triangles from `first` on that name vertices past those of the chunk. Precondition:
/// they come last, after those that are complete or are dropped as well.
void drop_incomplete_triangles(MeshChunk& chunk, std::size_t first);

/// Leaves only the window's own part in its mesh. Indices then count from the first own vertex, and
/// those past the own vertices name vertices of the next window.
void crop_to_own(MeshWindow& window);

}  // namespace mc::process
