// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "mc/field.hpp"
#include "mc/mesh.hpp"

namespace mc::pipe {

/// Gives vertices the materials of their places. A place in the lattice is worked out from the
/// vertex's position, so that the engine needs to know nothing of materials; positions were rounded
/// once, by no more than the 1/8192 of a cell that a format which holds materials may move them.
class VertexMaterials {
 public:
  /// Positions are what `to_world` makes of lattice coordinates, less `origin`. Keeps a reference.
  /// Errors   input: a map that cannot be inverted.
  VertexMaterials(const MaterialReader& materials, const Affine& to_world, const Vec3& origin);

  /// Fills the chunk's materials; returns how many of them are not what was asked for.
  std::uint64_t give(MeshChunk& chunk) const;

 private:
  template <class T>
  [[nodiscard]] std::uint64_t give(const Buffer<T>& positions, Buffer<std::uint16_t>& out) const;

  const MaterialReader& materials_;
  Affine to_lattice_;
  Vec3 origin_;
};

}  // namespace mc::pipe
