// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "extract/surface_sums.hpp"
#include "mc/mesh.hpp"
#include "mc/pipe.hpp"

// A run as the pipe sees it, dense or sparse: a list of tasks, each of which makes one chunk.

namespace mc::pipe {

/// What a task leaves behind, in a slot that is used again.
struct TaskResult {
  MeshChunk chunk;  ///< index_base counts from this task's first vertex until the pipe moves it
  extraction::TaskTotals totals;
};

/// The work of one extraction. make() may be called from several threads with different slots.
class TaskList {
 public:
  virtual ~TaskList() = default;
  /// Makes scratch for so many results at once; before make() or count().
  virtual void set_slots(std::size_t n_slots) = 0;
  /// The samples may be others from now on: what was kept of them is void.
  virtual void forget() {}
  [[nodiscard]] virtual std::size_t n_tasks() const = 0;
  /// Samples of task n, for progress.
  [[nodiscard]] virtual std::uint64_t samples(std::size_t n) const = 0;
  /// Reads what make() will need, where that must happen in order; called so before each make().
  virtual void fetch(std::size_t /*n*/, std::size_t /*slot*/) {}
  virtual void make(std::size_t n, std::size_t slot, TaskResult& out) = 0;
  /// Only counts.
  virtual void count(std::size_t n, std::size_t slot, TaskResult& out) = 0;
  /// Bytes that a run with so many slots holds beside chunks.
  [[nodiscard]] virtual std::uint64_t held_bytes(std::size_t n_slots) const = 0;
  /// Bytes of chunk that one task makes of a smooth surface.
  [[nodiscard]] virtual std::uint64_t chunk_bytes() const = 0;
};

std::unique_ptr<TaskList> dense_tasks(const SlabReader& reader, const RunOptions& options);
std::unique_ptr<TaskList> sparse_tasks(const LeafReader& reader, const RunOptions& options);

}  // namespace mc::pipe
