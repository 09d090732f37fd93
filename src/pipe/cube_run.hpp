// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <stop_token>

#include "mc/pipe.hpp"
#include "pipe/cube_plan.hpp"
#include "pipe/tasks.hpp"

// Runs with cube stages: a pass that counts, and one that makes the mesh.

namespace mc::pipe {

/// Options of the tasks that make the mesh which cube stages change, if there are any: what the
/// sink makes of it is replaced by what the cubes make.
RunOptions extraction_options(const RunOptions& options);

/// Options of the extraction that is counted for runs of these options.
RunOptions counting_options(const RunOptions& options);

/// Counts the mesh that `tasks`, which `counting` describes, make for the cube stages of `options`.
CubePlan plan_cubes(TaskList& tasks, const VolumeReader& reader, const RunOptions& counting,
                    const RunOptions& options, Progress& progress, const std::stop_token& stop);

/// Memory of the cubes: for as many at once as leave a quarter of the budget to the extraction.
KeptBytes kept_bytes(TaskList& tasks, const CubeBytes& cubes, const RunOptions& options);

struct CubeRun {
  TaskList& tasks;  ///< set to the room
  const Room& room;
  const CubePlan& plan;
  const VolumeReader& reader;
  const RunOptions& options;  ///< with to_world
  bool allow_empty;
  const std::optional<ComponentCounts>& components;
};

/// As mc::run().
MeshTotals run_cubes(const CubeRun& run, MeshSink& sink, Progress& progress,
                     const std::stop_token& stop);

}  // namespace mc::pipe
