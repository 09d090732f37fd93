// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <cstdint>
#include <string>

#include "mc/mesh.hpp"

// What every mesh sink counts, and what it says when counts do not fit.

namespace mc::sink {

/// Vertices and triangles of one object as they come.
struct ObjectCounts {
  std::uint64_t n_vertices = 0;
  std::uint64_t n_triangles = 0;

  /// Adds what `chunk`, a part of `object`, holds.
  void add([[maybe_unused]] const MeshObject& object, const MeshChunk& chunk) {
    assert(chunk.indices.size() % 3 == 0);
    assert(object.precision == Precision::f32 ? chunk.positions_f64.empty()
                                              : chunk.positions.empty());
    assert(chunk.normals.size() == (object.has_normals ? 3 * chunk.n_vertices() : 0));
    assert(chunk.attributes.size() == object.attributes.size());
    n_vertices += chunk.n_vertices();
    n_triangles += chunk.n_triangles();
  }
};

inline bool counts_known(const MeshObject& object) {
  return object.n_vertices.has_value() && object.n_triangles.has_value();
}

/// Throws limit when `n` exceeds `most`; `thing` is "vertices" or "triangles".
inline void check_limit(const std::string& place, std::uint64_t n, std::string_view thing,
                        std::string_view format, std::uint64_t most, std::string_view remedy) {
  if (n > most) {
    throw Error(ErrorKind::limit, place,
                std::to_string(n).append(" ").append(thing).append(", but ").append(format).append(
                    " holds at most ") +
                    std::to_string(most),
                remedy);
  }
}

/// A counting pass that was wrong has already misplaced what follows.
inline void check_announced(const std::string& place, const MeshObject& object,
                            const ObjectCounts& came) {
  if (object.n_vertices.value_or(came.n_vertices) != came.n_vertices ||
      object.n_triangles.value_or(came.n_triangles) != came.n_triangles) {
    throw Error(ErrorKind::internal, place,
                "the counting pass and the extraction differ: " + std::to_string(came.n_vertices) +
                    " vertices and " + std::to_string(came.n_triangles) + " triangles came");
  }
}

}  // namespace mc::sink
