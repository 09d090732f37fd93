// SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "mc/pipe.hpp"
#include "pipe/drive.hpp"
#include "pipe/tasks.hpp"

// A run: its tasks, as many slots as its memory allows, and the drive that takes it through.

namespace mc {

namespace {

std::unique_ptr<pipe::TaskList> tasks_for(const VolumeReader& reader, const RunOptions& options) {
  if (const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader)) {
    return pipe::dense_tasks(**dense, options);
  }
  return pipe::sparse_tasks(*std::get<std::unique_ptr<LeafReader>>(reader), options);
}

/// Of a run with so many chunks on their way, and what the sink makes of them.
std::uint64_t needed(const pipe::TaskList& tasks, std::size_t n_slots, const RunOptions& options) {
  return tasks.held_bytes(n_slots) + n_slots * tasks.chunk_bytes() * (1 + options.formatted);
}

std::string kibibytes(std::uint64_t bytes) {
  return std::to_string((bytes + 1023) / 1024) + " KiB";
}

/// As many slots as the memory allows: the fewer, the fewer threads have work.
std::size_t slots_within(const pipe::TaskList& tasks, const RunOptions& options) {
  std::size_t n_slots = base::pipeline_slots();
  while (needed(tasks, n_slots, options) > options.memory_bytes) {
    if (n_slots == 1) {
      throw Error(ErrorKind::limit, "--memory",
                  "this run needs about " + kibibytes(needed(tasks, 1, options)) + ", but only " +
                      kibibytes(options.memory_bytes) + " are allowed",
                  "raise --memory or extract in parts with --region");
    }
    n_slots = (n_slots + 1) / 2;
  }
  return n_slots;
}

}  // namespace

std::uint64_t memory_needed(const VolumeReader& reader, const RunOptions& options) {
  const std::size_t n_slots = base::pipeline_slots();
  return needed(*tasks_for(reader, options), n_slots, options);
}

void check_memory(const VolumeReader& reader, const RunOptions& options) {
  if (std::holds_alternative<std::unique_ptr<SlabReader>>(reader)) {
    slots_within(*tasks_for(reader, options), options);
  }
}

MeshTotals run(const VolumeReader& reader, const RunOptions& options, bool allow_empty,
               MeshSink& sink, Progress& progress, const std::stop_token& stop) {
  const auto tasks = tasks_for(reader, options);
  const std::size_t n_slots = slots_within(*tasks, options);
  tasks->set_slots(n_slots);
  RunOptions chosen = options;
  if (const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader)) {
    if ((*dense)->reads_once()) chosen.count_first = CountFirst::no;
  }
  return pipe::Drive().run(*tasks, n_slots, chosen, allow_empty, sink, progress, stop);
}

}  // namespace mc
