// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <shared_mutex>
#include <vector>

#include "mc/mesh.hpp"

// A mesh in memory is a sink: chunks are copied to where they belong by the threads that made them.

namespace mc::mesh {

/// Fills `mesh` from empty; its memory is kept. Errors: limit, for more than 2^32-1 vertices.
class MemorySink final : public MeshSink {
 public:
  /// Takes `mesh` as the next to fill, which nobody else touches until finish().
  void start(Mesh& mesh);

  void set_slots(std::size_t n_slots) override;
  void begin_object(const MeshObject& object) override;
  void place(const MeshChunk& chunk, std::size_t slot) override;
  void write(const MeshChunk& chunk, std::size_t slot) override;
  void end_object(const MeshTotals& totals) override;
  void finish() override;

 private:
  /// Where a chunk goes.
  struct Place {
    std::size_t vertex = 0;
    std::size_t triangle = 0;
  };

  Mesh* mesh_ = nullptr;
  std::vector<Place> places_;  // one a slot
  std::shared_mutex moving_;   // held alone while the mesh moves to larger memory
};

}  // namespace mc::mesh
