// SPDX-License-Identifier: MIT
#include "pipe/cube_run.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "pipe/cube_sink.hpp"
#include "pipe/drive.hpp"
#include "pipe/room.hpp"
#include "process/cube_stage_list.hpp"
#include "process/stage_list.hpp"

namespace mc::pipe {

namespace {

/// Drops the mesh: the counts are what is wanted.
class NullSink final : public MeshSink {
 public:
  void begin_object(const MeshObject& /*object*/) override {}
  void place(const MeshChunk& /*chunk*/, std::size_t /*slot*/) override {}
  void end_object(const MeshTotals& /*totals*/) override {}
  void finish() override {}
};

/// The first slots, whose chunks name no vertex before their own first one: those of tasks, and of
/// a sparse volume all, as pieces are tasks that are shorter.
std::size_t n_forward_slots(const VolumeReader& reader, const Room& room) {
  return is_dense(reader) ? room.n_slots : room.n_slots + room.n_makers;
}

/// Cubes at once that the kept memory was planned for.
std::size_t n_workers(const KeptBytes& kept, const CubeBytes& cubes) {
  if (cubes.worker == 0) return base::pipeline_slots();
  return static_cast<std::size_t>(1 + (kept.planned - kept.least) / cubes.worker);
}

MeshTotals make(const CubeRun& run, const CubeGrid& grid, const std::optional<MeshTotals>& counts,
                MeshSink& out, Progress& progress, const std::stop_token& stop) {
  const std::size_t n = n_workers(run.tasks.kept, run.plan.bytes);
  const CubeSink::Options options{run.options,
                                  run.plan,
                                  n_forward_slots(run.reader, run.room),
                                  n,
                                  n * run.plan.bytes.worker,
                                  cone_apex(volume_of(run.reader), run.options)};
  CubeSink sink(grid, options, out, stop);
  if (counts) sink.announce(*counts);
  Drive().run(run.tasks, run.room, extraction_options(run.options), run.allow_empty, run.components,
              sink, progress, stop);
  return sink.totals();
}

}  // namespace

RunOptions extraction_options(const RunOptions& options) {
  if (options.cube_stages.empty()) return options;
  RunOptions out = options;
  out.attributes = {};
  out.formatted = stored_bytes(options);
  out.extract.measure = false;
  out.count_first = CountFirst::no;
  // A layer of cubes is complete when a task has begun above it: tasks that are thicker than a part
  // of it hold more of the mesh than is planned, where their chunks do not.
  if (out.slab_layers == 0 && !process::StageList(options.stages).need_windows()) {
    out.slab_layers = std::max(process::CubeStageList(options.cube_stages).n_cells() / 8, 1);
  }
  return out;
}

RunOptions counting_options(const RunOptions& options) {
  RunOptions out = extraction_options(options);
  if (options.stages.empty()) out.extract.normals = Normals::none;
  return out;
}

CubePlan plan_cubes(TaskList& tasks, const VolumeReader& reader, const RunOptions& counting,
                    const RunOptions& options, Progress& progress, const std::stop_token& stop) {
  const Room room = room_within(tasks, counting);
  tasks.set_room(room);
  const CubeGrid grid = cube_grid(volume_of(reader), is_dense(reader), counting);
  CubeCounter counter(grid, n_forward_slots(reader, room));
  Drive().run(tasks, room, counting, true, {}, counter, progress, stop);
  return counter.plan(options);
}

KeptBytes kept_bytes(TaskList& tasks, const CubeBytes& cubes, const RunOptions& options) {
  const std::uint64_t held =
      process::CubeStageList(options.cube_stages).held_bytes() + cubes.stores;
  const std::uint64_t budget = memory_beside(tasks.input_bytes(), options.memory_bytes);
  const std::uint64_t extraction =
      std::max(least_bytes(tasks, extraction_options(options)), budget / 4);
  std::size_t n = base::pipeline_slots();
  while (n > 1 && held + n * cubes.worker + extraction > budget) --n;
  return {held + n * cubes.worker, held + cubes.worker};
}

MeshTotals run_cubes(const CubeRun& run, MeshSink& sink, Progress& progress,
                     const std::stop_token& stop) {
  const CubeGrid grid = cube_grid(volume_of(run.reader), is_dense(run.reader), run.options);
  if (run.options.count_first != CountFirst::yes) {
    return make(run, grid, std::nullopt, sink, progress, stop);
  }
  NullSink counting;
  const MeshTotals counts = make(run, grid, std::nullopt, counting, progress, stop);
  return make(run, grid, counts, sink, progress, stop);
}

}  // namespace mc::pipe
