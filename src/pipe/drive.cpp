// SPDX-License-Identifier: MIT
#include "pipe/drive.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "base/parallel.hpp"
#include "pipe/totals_sum.hpp"
#include "pipe/vertex_attributes.hpp"
#include "process/stage_list.hpp"

// A chunk stays with the thread that made it where its turn allows. Between a task and the end of
// its writing lie at most two slots a thread, so memory does not grow with the volume.

namespace mc::pipe {

namespace {

bool has_chunk(const TaskResult& result) {
  return result.chunk.n_vertices() != 0 || result.chunk.n_triangles() != 0;
}

/// Whether a task's chunk goes to the sink: one that is empty as well if pieces follow, so that
/// sinks see where each task starts.
bool is_placed(const TaskResult& task) { return has_chunk(task) || !task.complete; }

Error no_surface(const process::StageList& stages) {
  if (!stages.change_counts()) return {ErrorKind::empty, {}, "no surface at this iso"};
  return {ErrorKind::empty, {}, stages.window_names() + ": no surface is left at this iso"};
}

}  // namespace

/// One run. Its steps are small enough for a std::function to hold without memory of its own.
struct Drive::Work {
  TaskList& tasks;
  std::span<TaskResult> results;  ///< of tasks
  std::span<TaskResult> pieces;
  MeshSink& sink;
  Progress& progress;
  const std::stop_token& stop;
  process::StageList stages;
  MeshObject object;
  TotalsSum sum;
  std::optional<VertexAttributes> attributes;
  std::uint64_t n_numbered = 0;  ///< vertices of tasks that have their ids
  bool begun = false;

  void count(bool allow_empty);
  void announce(std::uint64_t n_vertices, std::uint64_t n_triangles, bool allow_empty);
  [[nodiscard]] bool is_large();
  [[nodiscard]] MeshTotals counts(std::size_t first, std::size_t stride);
  void extract();
  [[nodiscard]] std::uint64_t n_samples() const;
  void look_at_stop() const;
  void begin_object_once();
  void finish(TaskResult& result) const;
  void number(std::size_t slot);
  void place(std::size_t slot);
  void complete(std::size_t slot);
  void make_pieces(std::size_t n, std::uint64_t first_vertex, TaskResult& task);
};

std::uint64_t Drive::Work::n_samples() const {
  std::uint64_t n_samples = 0;
  for (std::size_t n = 0; n < tasks.n_tasks(); ++n) {
    n_samples += tasks.samples(n);
  }
  return n_samples;
}

void Drive::Work::look_at_stop() const {
  if (stop.stop_requested()) {
    throw Cancelled();
  }
}

void Drive::Work::begin_object_once() {
  if (!begun) {
    sink.set_slots(results.size() + pieces.size());
    sink.begin_object(object);
    begun = true;
  }
}

/// Does to a chunk what tasks leave to be done: all stages if each chunk is taken alone.
void Drive::Work::finish(TaskResult& result) const {
  if (!stages.empty() && !stages.need_windows()) {
    MeshWindow window{result.chunk, object.origin, {0, result.chunk.n_vertices()}, {}};
    stages.apply(window);
    if (stages.move_vertices()) result.totals.bounds = process::bounds_of(result.chunk);
  }
  if (attributes) {
    attributes->give(result.chunk, result.totals.n_clamped);
  } else {
    result.chunk.attributes.clear();
    result.totals.n_clamped.clear();
  }
}

void Drive::Work::number(std::size_t slot) {
  TaskResult& task = results[slot];
  task.chunk.index_base += n_numbered;
  n_numbered += task.totals.n_vertices;
  if (is_placed(task)) {
    begin_object_once();
  }
}

void Drive::Work::place(std::size_t slot) {
  TaskResult& task = results[slot];
  if (is_placed(task)) sink.place(task.chunk, slot);
  if (!task.complete) complete(slot);
  sum.add(task.totals);
}

/// Makes the rest of a task, before which all vertices and triangles have been placed.
void Drive::Work::complete(std::size_t slot) {
  TaskResult& task = results[slot];
  const std::uint64_t first_vertex = task.chunk.index_base + task.chunk.n_vertices();
  for (std::size_t n = tasks.next_pieces(slot); n != 0; n = tasks.next_pieces(slot)) {
    make_pieces(n, first_vertex, task);
  }
}

/// Takes pieces through the steps of a chunk; their vertices and triangles follow what is placed.
void Drive::Work::make_pieces(std::size_t n, std::uint64_t first_vertex, TaskResult& task) {
  const auto sink_slot = [this](std::size_t maker) { return results.size() + maker; };
  const std::array<base::Step, 3> steps{{
      {false,
       [&](std::size_t piece, std::size_t maker) {
         look_at_stop();
         tasks.make_piece(piece, maker, pieces[maker]);
         finish(pieces[maker]);
         pieces[maker].chunk.index_base += first_vertex;
         if (has_chunk(pieces[maker])) sink.format(pieces[maker].chunk, sink_slot(maker));
       }},
      {true,
       [&](std::size_t /*piece*/, std::size_t maker) {
         if (has_chunk(pieces[maker])) sink.place(pieces[maker].chunk, sink_slot(maker));
         task.totals.add_piece(pieces[maker].totals);
       }},
      {false,
       [&](std::size_t /*piece*/, std::size_t maker) {
         if (has_chunk(pieces[maker])) sink.write(pieces[maker].chunk, sink_slot(maker));
       }},
  }};
  base::pipeline(n, pieces.size(), steps);
}

/// Counts tasks first, first + stride, ...
MeshTotals Drive::Work::counts(std::size_t first, std::size_t stride) {
  TotalsSum counted(false);
  const auto nth = [first, stride](std::size_t item) { return first + item * stride; };
  const std::array<base::Step, 2> steps{{
      {false,
       [&](std::size_t item, std::size_t slot) {
         look_at_stop();
         tasks.count(nth(item), slot, results[slot]);
       }},
      {true,
       [&](std::size_t item, std::size_t slot) {
         counted.add(results[slot].totals);
         if (stride == 1) progress.advance(tasks.samples(item));
       }},
  }};
  const std::size_t n_tasks = tasks.n_tasks();
  base::pipeline(n_tasks > first ? (n_tasks - first + stride - 1) / stride : 0, results.size(),
                 steps);
  return counted.totals({});
}

/// Whether counts are worth a read of all samples, judged by a few layers or some of the tasks.
/// Measured on files in memory: spooling a triangle costs as much as counting 22 samples. A mesh of
/// more than ten million triangles may be more than a format can hold, which is better known before
/// the work.
bool Drive::Work::is_large() {
  constexpr std::size_t kStride = 16;
  constexpr std::uint64_t kSamplesPerTriangle = 22, kMany = 10'000'000;
  std::optional<std::uint64_t> about = tasks.estimate_triangles();
  if (!about) about = kStride * counts(kStride / 2, kStride).n_triangles;
  return *about > kMany || *about * kSamplesPerTriangle > n_samples();
}

void Drive::Work::count(bool allow_empty) {
  progress.begin("count", n_samples(), "samples");
  const MeshTotals counted = counts(0, 1);
  announce(counted.n_vertices, counted.n_triangles, allow_empty);
}

void Drive::Work::announce(std::uint64_t n_vertices, std::uint64_t n_triangles, bool allow_empty) {
  object.n_vertices = n_vertices;
  object.n_triangles = n_triangles;
  if (n_triangles == 0 && !allow_empty) throw no_surface(stages);
  if (n_triangles != 0) begin_object_once();  // what a sink cannot hold is not made
}

void Drive::Work::extract() {
  progress.begin("extract", n_samples(), "samples");
  const std::array<base::Step, 6> steps{{
      {true,
       [this](std::size_t n, std::size_t slot) {
         look_at_stop();
         tasks.fetch(n, slot);
       }},
      {false,
       [this](std::size_t n, std::size_t slot) {
         look_at_stop();
         tasks.make(n, slot, results[slot]);
         finish(results[slot]);
       }},
      {true, [this](std::size_t /*n*/, std::size_t slot) { number(slot); }},
      {false,
       [this](std::size_t /*n*/, std::size_t slot) {
         if (is_placed(results[slot])) sink.format(results[slot].chunk, slot);
       }},
      {true, [this](std::size_t /*n*/, std::size_t slot) { place(slot); }},
      {false,
       [this](std::size_t n, std::size_t slot) {
         look_at_stop();
         if (is_placed(results[slot])) sink.write(results[slot].chunk, slot);
         progress.advance(tasks.samples(n));
       }},
  }};
  base::pipeline(tasks.n_tasks(), results.size(), steps);
}

MeshTotals Drive::run(TaskList& tasks, const Room& room, const RunOptions& options,
                      bool allow_empty, const std::optional<ComponentCounts>& components,
                      MeshSink& sink, Progress& progress, const std::stop_token& stop) {
  results_.resize(std::max(results_.size(), room.n_slots + room.n_makers));
  const std::span results(results_);
  Work work{tasks,
            results.first(room.n_slots),
            results.subspan(room.n_slots, room.n_makers),
            sink,
            progress,
            stop,
            process::StageList(options.stages),
            options.object,
            TotalsSum(options.extract.measure),
            std::nullopt};
  if (!options.attributes.empty()) {
    work.attributes.emplace(options.attributes, options.to_world.value(), options.extract.origin);
  }
  work.object.iso = options.extract.iso;
  work.object.has_normals = options.extract.normals != Normals::none;
  work.object.attributes.clear();
  for (const AttributeReader* reader : options.attributes) {
    work.object.attributes.push_back(reader->info());
  }
  work.object.precision = options.extract.precision;
  work.object.origin = options.extract.origin;
  work.stages.describe(work.object);
  const CountFirst count = options.count_first;
  if (const std::optional<Counts> known = tasks.known_counts()) {
    work.announce(known->n_vertices, known->n_triangles, allow_empty);
  } else if (count == CountFirst::yes || (count == CountFirst::if_large && work.is_large())) {
    work.count(allow_empty);
  }
  work.extract();
  MeshTotals totals = work.sum.totals(work.object.origin);
  totals.components = components;
  if (totals.n_triangles == 0 && !allow_empty) {
    throw no_surface(work.stages);
  }
  work.begin_object_once();
  sink.end_object(totals);
  return totals;
}

}  // namespace mc::pipe
