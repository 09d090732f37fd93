// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "pipe/tasks.hpp"

// A run's budget, dealt out: to what the tasks hold, to their chunks, and to what the sink makes of
// these.

namespace mc::pipe {

/// What the program holds before it starts, stacks and small things besides: measured, and as much
/// again.
inline constexpr std::uint64_t kProgramBytes = 12U << 20U;

/// "3 MiB", rounded up.
std::string mebibytes(std::uint64_t bytes);

/// "a, b": the stages for which samples are read more than once and memory depends on the surface.
std::string names_of_rereading(const RunOptions& options);

/// Fits tasks into the memory that `options` allow, with as many on their way as there is room for.
/// Errors   limit: not even one at a time; the message names the least budget.
Room room_within(TaskList& tasks, const RunOptions& options);

/// The least memory that room_within() takes.
std::uint64_t least_bytes(TaskList& tasks, const RunOptions& options);

/// Bytes that a run of so much room holds at most, what the program holds anyway included, where a
/// task fills its chunk with `content_bytes` at most.
std::uint64_t bytes_of(const TaskList& tasks, const Room& room, std::uint64_t content_bytes,
                       const RunOptions& options);

}  // namespace mc::pipe
