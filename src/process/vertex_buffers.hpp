// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "mc/mesh.hpp"

namespace mc::process {

/// Calls visit(buffer, n) for each buffer of a chunk that has n elements for each vertex. A buffer
/// that the mesh does not use is empty.
template <class Visit>
void for_vertex_buffers(MeshChunk& chunk, Visit&& visit) {
  visit(chunk.positions, std::size_t{3});
  visit(chunk.positions_f64, std::size_t{3});
  visit(chunk.normals, std::size_t{3});
}

}  // namespace mc::process
