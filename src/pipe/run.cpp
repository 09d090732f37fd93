// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>

#include "base/parallel.hpp"
#include "mc/pipe.hpp"
#include "pipe/tasks.hpp"

// Runs the tasks of an extraction on all threads and hands their chunks to the sink in order.
// Between a task and its consumption lie at most two slots a thread, so memory does not grow with
// the volume.

namespace mc {

namespace {

std::size_t slots_for(int n_threads) {
  return n_threads == 1 ? 1 : 2 * static_cast<std::size_t>(n_threads);
}

std::unique_ptr<pipe::TaskList> tasks_for(const VolumeReader& reader, const RunOptions& options) {
  if (const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader)) {
    return pipe::dense_tasks(**dense, options);
  }
  return pipe::sparse_tasks(*std::get<std::unique_ptr<LeafReader>>(reader), options);
}

std::uint64_t needed(const pipe::TaskList& tasks, std::size_t n_slots) {
  return tasks.held_bytes(n_slots) + n_slots * tasks.chunk_bytes();
}

std::string kibibytes(std::uint64_t bytes) {
  return std::to_string((bytes + 1023) / 1024) + " KiB";
}

/// As many slots as the memory allows: the fewer, the fewer threads have work.
std::size_t slots_within(const pipe::TaskList& tasks, std::uint64_t memory_bytes) {
  std::size_t n_slots = slots_for(base::thread_count());
  while (needed(tasks, n_slots) > memory_bytes) {
    if (n_slots == 1) {
      throw Error(ErrorKind::limit, "--memory",
                  "this run needs about " + kibibytes(needed(tasks, 1)) + ", but only " +
                      kibibytes(memory_bytes) + " are allowed",
                  "raise --memory or extract in parts with --region");
    }
    n_slots = (n_slots + 1) / 2;
  }
  return n_slots;
}

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

/// All tasks, stage `name`; `consume` sees each result in order.
template <class Make, class Consume>
void run_tasks(std::string_view name, const pipe::TaskList& tasks, std::size_t n_slots,
               Progress& progress, const std::stop_token& stop, Make&& make, Consume&& consume) {
  std::uint64_t n_samples = 0;
  for (std::size_t n = 0; n < tasks.n_tasks(); ++n) {
    n_samples += tasks.samples(n);
  }
  progress.begin(name, n_samples, "samples");
  std::vector<pipe::TaskResult> results(n_slots);
  base::ordered_pipeline(
      tasks.n_tasks(), n_slots,
      [&](std::size_t n, std::size_t slot) {
        if (stop.stop_requested()) {
          throw Cancelled();
        }
        make(n, slot, results[slot]);
      },
      [&](std::size_t n, std::size_t slot) {
        if (stop.stop_requested()) {
          throw Cancelled();
        }
        consume(results[slot]);
        progress.advance(tasks.samples(n));
      });
}

Error no_surface() { return {ErrorKind::empty, {}, "no surface at this iso"}; }

}  // namespace

std::uint64_t memory_needed(const VolumeReader& reader, const RunOptions& options) {
  const std::size_t n_slots = slots_for(base::thread_count());
  return needed(*tasks_for(reader, options), n_slots);
}

void check_memory(const VolumeReader& reader, const RunOptions& options) {
  if (std::holds_alternative<std::unique_ptr<SlabReader>>(reader)) {
    slots_within(*tasks_for(reader, options), options.memory_bytes);
  }
}

MeshTotals run(const VolumeReader& reader, const RunOptions& options, bool allow_empty,
               MeshSink& sink, Progress& progress, const std::stop_token& stop) {
  const auto tasks = tasks_for(reader, options);
  const std::size_t n_slots = slots_within(*tasks, options.memory_bytes);
  tasks->set_slots(n_slots);
  MeshObject object = options.object;
  object.iso = options.extract.iso;
  object.has_normals = options.extract.normals != Normals::none;
  object.precision = options.extract.precision;
  object.origin = options.extract.origin;
  if (options.count_first) {
    Sum counted(false);
    run_tasks(
        "count", *tasks, n_slots, progress, stop,
        [&](std::size_t n, std::size_t slot, pipe::TaskResult& r) { tasks->count(n, slot, r); },
        [&](const pipe::TaskResult& r) { counted.add(r.totals); });
    object.n_vertices = counted.totals({}).n_vertices;
    object.n_triangles = counted.totals({}).n_triangles;
    if (object.n_triangles == 0U && !allow_empty) throw no_surface();
  }
  Sum sum(options.extract.measure);
  bool begun = false;
  const auto begin_once = [&] {
    if (!begun) {
      sink.begin_object(object);
      begun = true;
    }
  };
  run_tasks(
      "extract", *tasks, n_slots, progress, stop,
      [&](std::size_t n, std::size_t slot, pipe::TaskResult& r) { tasks->make(n, slot, r); },
      [&](pipe::TaskResult& r) {
        if (r.chunk.n_vertices() != 0 || r.chunk.n_triangles() != 0) {
          begin_once();
          r.chunk.index_base += sum.n_vertices();
          sink.write(r.chunk);
        }
        sum.add(r.totals);
      });
  const MeshTotals totals = sum.totals(object.origin);
  if (totals.n_triangles == 0 && !allow_empty) {
    throw no_surface();
  }
  begin_once();
  sink.end_object(totals);
  return totals;
}

}  // namespace mc
