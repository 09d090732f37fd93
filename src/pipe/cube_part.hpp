// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mc/process.hpp"
#include "pipe/cube_store.hpp"

namespace mc::pipe {

/// The mesh of one cube on its way through a pass, with scratch that is used again.
class CubePart {
 public:
  MeshChunk mesh;                   ///< vertices of the seam first
  std::vector<std::uint32_t> seam;  ///< their numbers in the store
  VertexDistances distances;

  /// Copies the cube out of the store. Vertices are ordered by their numbers there: first those of
  /// the seam, which are shared or have an entry in `open` that is not 0 (none if it is empty),
  /// then the others.
  void gather(const CubeStore& store, const CubeStore::Cube& cube,
              std::span<const std::uint8_t> open);

 private:
  /// Some of the vertices of the store in a range, which are numbered in order.
  class Subset {
   public:
    void clear(std::uint32_t first, std::uint32_t last);
    void add(std::uint32_t vertex);
    [[nodiscard]] bool has(std::uint32_t vertex) const;
    /// Numbers those that were added from `next` on; returns the number after the last.
    std::uint32_t number(std::uint32_t next);
    [[nodiscard]] std::uint32_t number_of(std::uint32_t vertex) const;
    template <class Visit>
    void for_each(Visit&& visit) const;

   private:
    std::uint32_t first_word_ = 0;
    std::vector<std::uint64_t> words_;
    std::vector<std::uint32_t> before_;
  };

  void copy_vertices(const MeshChunk& from, std::size_t n_vertices);

  Subset seam_set_, inner_set_;
};

/// Bytes of a CubePart beside its mesh for each vertex, at most two of three vertices of the store
/// lying between those of one cube.
inline constexpr std::uint64_t kPartVertexBytes = 2 * sizeof(std::uint32_t);

}  // namespace mc::pipe
