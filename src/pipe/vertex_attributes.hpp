// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mc/field.hpp"
#include "mc/mesh.hpp"

namespace mc::pipe {

/// Gives vertices the attributes of their places. A place in the lattice is worked out from the
/// vertex's position, so that the engine needs to know nothing of attributes; positions were
/// rounded once, by no more than the 1/8192 of a cell that a format may move them.
class VertexAttributes {
 public:
  /// Positions are what `to_world` makes of lattice coordinates, less `origin`. Keeps the readers.
  /// Errors   input: a map that cannot be inverted.
  VertexAttributes(AttributeReaders readers, const Affine& to_world, const Vec3& origin);

  /// Fills the chunk's attributes, and of each how many values were clamped. Allocates nothing for
  /// a chunk that had as many vertices and the same attributes before.
  void give(MeshChunk& chunk, std::vector<std::uint64_t>& n_clamped) const;

 private:
  template <class T>
  void give(const Buffer<T>& positions, MeshChunk& chunk,
            std::vector<std::uint64_t>& n_clamped) const;

  AttributeReaders readers_;
  Affine to_lattice_;
  Vec3 origin_;
};

}  // namespace mc::pipe
