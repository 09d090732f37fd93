// SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "mc/pipe.hpp"
#include "pipe/drive.hpp"
#include "pipe/room.hpp"
#include "pipe/tasks.hpp"

// A run: its tasks, as much room as its memory allows, and the drive that takes it through.

namespace mc {

namespace {

std::unique_ptr<pipe::TaskList> tasks_for(const VolumeReader& reader, const RunOptions& options) {
  if (const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader)) {
    return pipe::dense_tasks(**dense, options);
  }
  return pipe::sparse_tasks(*std::get<std::unique_ptr<LeafReader>>(reader), options);
}

}  // namespace

std::uint64_t memory_needed(const VolumeReader& reader, const RunOptions& options) {
  const auto tasks = tasks_for(reader, options);
  pipe::Room room = pipe::room_within(*tasks, options);
  room.chunk_bytes = std::min(room.chunk_bytes, tasks->smooth_chunk_bytes());
  room.piece_bytes = 0;
  return pipe::bytes_of(*tasks, room, options);
}

void check_memory(const VolumeReader& reader, const RunOptions& options) {
  if (std::holds_alternative<std::unique_ptr<SlabReader>>(reader)) {
    pipe::room_within(*tasks_for(reader, options), options);
  }
}

MeshTotals run(const VolumeReader& reader, const RunOptions& options, bool allow_empty,
               MeshSink& sink, Progress& progress, const std::stop_token& stop) {
  const auto tasks = tasks_for(reader, options);
  const pipe::Room room = pipe::room_within(*tasks, options);
  tasks->set_room(room);
  RunOptions chosen = options;
  chosen.to_world = options.to_world.value_or(volume_of(reader).lattice.to_world);
  if (const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader)) {
    if ((*dense)->reads_once()) chosen.count_first = CountFirst::no;
  }
  return pipe::Drive().run(*tasks, room, chosen, allow_empty, sink, progress, stop);
}

}  // namespace mc
