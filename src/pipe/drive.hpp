// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "mc/mesh.hpp"
#include "mc/pipe.hpp"
#include "pipe/tasks.hpp"

// The tasks of one extraction, made on all threads, and their chunks' way into the sink:
// fetched, in order -> made -> numbered, in order -> formatted -> placed, in order -> written.
// A task that its chunk could not hold is completed when it is placed: piece by piece, on all
// threads again.

namespace mc::pipe {

/// Holds the chunks on their way, whose memory is used again from run to run.
class Drive {
 public:
  /// Runs all tasks, which have been set to this room; as mc::run(). With attributes, the options
  /// have the map to the world. `components` go into the totals.
  MeshTotals run(TaskList& tasks, const Room& room, const RunOptions& options, bool allow_empty,
                 const std::optional<ComponentCounts>& components, MeshSink& sink,
                 Progress& progress, const std::stop_token& stop);

 private:
  struct Work;
  std::vector<TaskResult> results_;
};

}  // namespace mc::pipe
