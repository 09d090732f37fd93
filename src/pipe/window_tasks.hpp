// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "mc/pipe.hpp"
#include "pipe/plane_input.hpp"
#include "pipe/tasks.hpp"

namespace mc::pipe {

/// Tasks with stages that reach beyond a chunk. Precondition: options.stages need windows; `input`
/// can be read again, unless the tasks only answer for their memory.
/// Errors   as dense_tasks() and sparse_tasks().
std::unique_ptr<TaskList> dense_window_tasks(const PlaneInput& input, const RunOptions& options);
std::unique_ptr<TaskList> sparse_window_tasks(const LeafReader& reader, const RunOptions& options);

}  // namespace mc::pipe
