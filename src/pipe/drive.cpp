// SPDX-License-Identifier: MIT
#include "pipe/drive.hpp"

#include <array>
#include <span>

#include "base/parallel.hpp"

// A chunk stays with the thread that made it where its turn allows. Between a task and the end of
// its writing lie at most two slots a thread, so memory does not grow with the volume.

namespace mc::pipe {

namespace {

/// Adds up what tasks found, in their order.
class Sum {
 public:
  explicit Sum(bool measured) {
    if (measured) {
      totals_.area = 0;
      totals_.volume = 0;
    }
  }
  void add(const extraction::TaskTotals& task) {
    totals_.n_vertices += task.n_vertices;
    totals_.n_triangles += task.n_triangles;
    totals_.n_boundary_edges += task.n_boundary_edges;
    totals_.bounds.include(task.bounds);
    totals_.n_asked += task.n_asked;
    totals_.n_skipped += task.n_skipped;
    for (const extraction::LayerSum& layer : task.layers) {
      *totals_.area += layer.area;
      *totals_.volume += layer.volume;
    }
  }
  [[nodiscard]] MeshTotals totals(const Vec3& origin) const {
    MeshTotals out = totals_;
    if (out.n_boundary_edges != 0) {
      out.volume.reset();  // an open surface encloses none
    }
    if (!out.bounds.empty()) {
      for (std::size_t a = 0; a < 3; ++a) {
        out.bounds.lo[a] += origin[a];
        out.bounds.hi[a] += origin[a];
      }
    }
    return out;
  }
  [[nodiscard]] std::uint64_t n_vertices() const { return totals_.n_vertices; }

 private:
  MeshTotals totals_;
};

Error no_surface() { return {ErrorKind::empty, {}, "no surface at this iso"}; }

}  // namespace

/// One run. Its steps are small enough for a std::function to hold without memory of its own.
struct Drive::Work {
  TaskList& tasks;
  std::span<TaskResult> results;
  MeshSink& sink;
  Progress& progress;
  const std::stop_token& stop;
  MeshObject object;
  Sum sum;
  bool begun = false;

  void count(bool allow_empty);
  [[nodiscard]] bool is_large();
  [[nodiscard]] MeshTotals counts(std::size_t first, std::size_t stride);
  void extract();
  [[nodiscard]] std::uint64_t n_samples() const;
  void look_at_stop() const;
  void begin_object_once();
  void number(std::size_t slot);
  [[nodiscard]] bool has_chunk(std::size_t slot) const;
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
    sink.set_slots(results.size());
    sink.begin_object(object);
    begun = true;
  }
}

bool Drive::Work::has_chunk(std::size_t slot) const {
  const MeshChunk& chunk = results[slot].chunk;
  return chunk.n_vertices() != 0 || chunk.n_triangles() != 0;
}

void Drive::Work::number(std::size_t slot) {
  results[slot].chunk.index_base += sum.n_vertices();
  sum.add(results[slot].totals);
  if (has_chunk(slot)) {
    begin_object_once();
  }
}

/// Counts tasks first, first + stride, ...
MeshTotals Drive::Work::counts(std::size_t first, std::size_t stride) {
  Sum counted(false);
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

/// Whether counts are worth a read of all samples, judged by some of the tasks. Measured on files
/// in memory: spooling a triangle costs as much as counting 22 samples. A mesh of more than ten
/// million triangles may be more than a format can hold, which is better known before the work.
bool Drive::Work::is_large() {
  constexpr std::size_t kStride = 16;
  constexpr std::uint64_t kSamplesPerTriangle = 22, kMany = 10'000'000;
  const std::uint64_t about = kStride * counts(kStride / 2, kStride).n_triangles;
  return about > kMany || about * kSamplesPerTriangle > n_samples();
}

void Drive::Work::count(bool allow_empty) {
  progress.begin("count", n_samples(), "samples");
  const MeshTotals counted = counts(0, 1);
  object.n_vertices = counted.n_vertices;
  object.n_triangles = counted.n_triangles;
  if (object.n_triangles == 0U && !allow_empty) throw no_surface();
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
       }},
      {true, [this](std::size_t /*n*/, std::size_t slot) { number(slot); }},
      {false,
       [this](std::size_t /*n*/, std::size_t slot) {
         if (has_chunk(slot)) sink.format(results[slot].chunk, slot);
       }},
      {true,
       [this](std::size_t /*n*/, std::size_t slot) {
         if (has_chunk(slot)) sink.place(results[slot].chunk, slot);
       }},
      {false,
       [this](std::size_t n, std::size_t slot) {
         look_at_stop();
         if (has_chunk(slot)) sink.write(results[slot].chunk, slot);
         progress.advance(tasks.samples(n));
       }},
  }};
  base::pipeline(tasks.n_tasks(), results.size(), steps);
}

MeshTotals Drive::run(TaskList& tasks, std::size_t n_slots, const RunOptions& options,
                      bool allow_empty, MeshSink& sink, Progress& progress,
                      const std::stop_token& stop) {
  if (results_.size() < n_slots) {
    results_.resize(n_slots);
  }
  Work work{tasks,          std::span(results_).first(n_slots), sink, progress, stop,
            options.object, Sum(options.extract.measure)};
  work.object.iso = options.extract.iso;
  work.object.has_normals = options.extract.normals != Normals::none;
  work.object.precision = options.extract.precision;
  work.object.origin = options.extract.origin;
  const CountFirst count = options.count_first;
  if (count == CountFirst::yes || (count == CountFirst::if_large && work.is_large())) {
    work.count(allow_empty);
  }
  work.extract();
  const MeshTotals totals = work.sum.totals(work.object.origin);
  if (totals.n_triangles == 0 && !allow_empty) {
    throw no_surface();
  }
  work.begin_object_once();
  sink.end_object(totals);
  return totals;
}

}  // namespace mc::pipe
