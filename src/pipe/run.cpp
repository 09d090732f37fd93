// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cassert>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "mc/pipe.hpp"
#include "mesh/chunk_room.hpp"
#include "pipe/cube_run.hpp"
#include "pipe/drive.hpp"
#include "pipe/label_components.hpp"
#include "pipe/room.hpp"
#include "pipe/tasks.hpp"
#include "pipe/window_tasks.hpp"
#include "process/cube_stage_list.hpp"
#include "process/stage_list.hpp"

// A run: its tasks, as much room as its memory allows, and the drive that takes it through.

namespace mc {

namespace {

std::unique_ptr<pipe::TaskList> dense_tasks_for(const pipe::PlaneInput& input,
                                                const RunOptions& options) {
  return process::StageList(options.stages).need_windows()
             ? pipe::dense_window_tasks(input, options)
             : pipe::dense_tasks(input, options);
}

std::unique_ptr<pipe::TaskList> tasks_for(const VolumeReader& reader, const RunOptions& options) {
  process::StageList(options.stages).check();
  process::CubeStageList(options.cube_stages).check();
  if (options.extract.part && !options.cube_stages.empty()) {
    throw Error(ErrorKind::usage, "part",
                "layers have no mesh of their own with " +
                    process::CubeStageList(options.cube_stages).names());
  }
  if (is_dense(reader)) {
    if (options.extract.part && is_stream(reader)) {
      throw Error(ErrorKind::usage, volume_of(reader).name, "a stream cannot be meshed in parts");
    }
    return dense_tasks_for(pipe::PlaneInput::of(reader), options);
  }
  const LeafReader& leaves = *std::get<std::unique_ptr<LeafReader>>(reader);
  return process::StageList(options.stages).need_windows()
             ? pipe::sparse_window_tasks(leaves, options)
             : pipe::sparse_tasks(leaves, options);
}

/// Tasks that are planned as far as they must be, and the plan of cubes, if there are cube stages.
struct Planned {
  std::unique_ptr<pipe::TaskList> tasks;
  std::optional<pipe::CubePlan> cubes;
};

/// A budget that is too small for any surface is refused before anything is read.
void plan_windows(const VolumeReader& reader, const RunOptions& options, Progress& progress,
                  const std::stop_token& stop, pipe::TaskList& tasks) {
  if (!process::StageList(options.stages).need_windows() || is_stream(reader)) return;
  pipe::room_within(tasks, pipe::extraction_options(options));
  tasks.plan(progress, stop);
}

Planned planned(const VolumeReader& reader, const RunOptions& options, Progress& progress,
                const std::stop_token& stop) {
  Planned out{tasks_for(reader, pipe::extraction_options(options)), std::nullopt};
  plan_windows(reader, options, progress, stop, *out.tasks);
  if (options.cube_stages.empty() || is_stream(reader)) return out;
  const RunOptions counting = pipe::counting_options(options);
  const auto tasks = tasks_for(reader, counting);
  plan_windows(reader, counting, progress, stop, *tasks);
  out.cubes = pipe::plan_cubes(*tasks, reader, counting, options, progress, stop);
  out.tasks->kept = pipe::kept_bytes(*out.tasks, out.cubes->bytes, options);
  return out;
}

void refuse_stream(const VolumeReader& reader, const RunOptions& options) {
  const std::string names = pipe::names_of_rereading(options);
  if (is_stream(reader) && !names.empty()) {
    throw Error(ErrorKind::usage, volume_of(reader).name,
                "a stream is read only once, but " + names + " needs more",
                "copy the stream to disk first");
  }
}

/// Changes what the tasks were fit to.
MemoryNeed need_of(pipe::TaskList& tasks, const RunOptions& run_options) {
  const RunOptions options = pipe::extraction_options(run_options);
  MemoryNeed need;
  need.budget = options.memory_bytes;
  need.least = pipe::least_bytes(tasks, options);
  const pipe::Room room = pipe::room_within(tasks, options);
  need.most = pipe::bytes_of(tasks, room, tasks.most_content_bytes(), options);
  need.expected = pipe::bytes_of(tasks, room, tasks.smooth_content_bytes(), options);
  return need;
}

/// Bytes that the largest chunk of a task is filled with.
std::uint64_t counted_content(pipe::TaskList& tasks, std::size_t n_slots, const RunOptions& options,
                              const std::stop_token& stop) {
  const ExtractOptions& o = options.extract;
  const std::uint64_t vertex = mesh::vertex_bytes(o.precision, o.normals != Normals::none);
  std::vector<pipe::TaskResult> counted(n_slots);
  std::uint64_t most = 0;
  const std::array<base::Step, 2> steps{
      {{false,
        [&](std::size_t n, std::size_t slot) {
          if (stop.stop_requested()) throw Cancelled();
          tasks.count(n, slot, counted[slot]);
        }},
       {true, [&](std::size_t /*n*/, std::size_t slot) {
          const pipe::TaskTotals& totals = counted[slot].totals;
          most = std::max(most, mesh::content_bytes(totals.n_vertices, totals.n_triangles, vertex));
        }}}};
  base::pipeline(tasks.n_tasks(), n_slots, steps);
  return most;
}

/// Makes the mesh in one pass; `components` are those that were told apart before.
MeshTotals run_pass(const VolumeReader& reader, const RunOptions& options, bool allow_empty,
                    const std::optional<ComponentCounts>& components, MeshSink& sink,
                    Progress& progress, const std::stop_token& stop) {
  const process::StageList stages(options.stages);
  refuse_stream(reader, options);
  RunOptions chosen = options;
  // Stages that take each chunk alone leave no triangle to measure.
  if (stages.move_vertices() && !stages.need_windows() && options.cube_stages.empty()) {
    chosen.extract.measure = false;
  }
  chosen.to_world = options.to_world.value_or(volume_of(reader).lattice.to_world);
  if (is_stream(reader)) chosen.count_first = CountFirst::no;
  const Planned plan = planned(reader, chosen, progress, stop);
  if (options.tell_need) options.tell_need(need_of(*plan.tasks, chosen));
  const pipe::Room room = pipe::room_within(*plan.tasks, pipe::extraction_options(chosen));
  plan.tasks->set_room(room);
  if (plan.cubes) {
    const pipe::CubeRun run{*plan.tasks, room,        *plan.cubes, reader,
                            chosen,      allow_empty, components};
    return pipe::run_cubes(run, sink, progress, stop);
  }
  return pipe::Drive().run(*plan.tasks, room, chosen, allow_empty, components, sink, progress,
                           stop);
}

}  // namespace

MemoryNeed memory_needed(const VolumeReader& reader, const RunOptions& options) {
  return need_of(*planned(reader, options, silent_progress(), {}).tasks, options);
}

MemoryNeed memory_counted(const VolumeReader& reader, const RunOptions& options,
                          const std::stop_token& stop, bool streamed) {
  assert(options.cube_stages.empty());
  const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader);
  const auto tasks = streamed && dense != nullptr
                         ? dense_tasks_for(pipe::PlaneInput::planned_as_stream(**dense), options)
                         : tasks_for(reader, options);
  tasks->plan(silent_progress(), stop);
  MemoryNeed need = need_of(*tasks, options);
  const pipe::Room room = pipe::room_within(*tasks, options);
  tasks->set_room(room);
  need.expected =
      pipe::bytes_of(*tasks, room, counted_content(*tasks, room.n_slots, options, stop), options);
  return need;
}

void check_memory(const VolumeReader& reader, const RunOptions& options) {
  if (is_dense(reader)) pipe::room_within(*tasks_for(reader, options), options);
}

MeshTotals run(const VolumeReader& reader, const RunOptions& options, bool allow_empty,
               MeshSink& sink, Progress& progress, const std::stop_token& stop) {
  if (!options.keep) return run_pass(reader, options, allow_empty, {}, sink, progress, stop);
  if (is_stream(reader)) {
    throw Error(ErrorKind::usage, volume_of(reader).name,
                "a stream cannot be read twice, as it takes to leave out components");
  }
  const pipe::SelectedComponents selected = pipe::label_and_select(reader, options, progress, stop);
  const ComponentCounts& counts = selected.counts;
  if (counts.found != 0 && counts.kept == 0 && !allow_empty) {
    throw Error(ErrorKind::empty, {},
                "none of the " + std::to_string(counts.found) + " components is large enough",
                Remedy::keep_smaller);
  }
  RunOptions chosen = options;
  chosen.extract.selection = &selected.selection;
  return run_pass(reader, chosen, allow_empty, counts, sink, progress, stop);
}

}  // namespace mc
