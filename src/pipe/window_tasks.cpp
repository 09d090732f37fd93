// SPDX-License-Identifier: MIT
#include "pipe/window_tasks.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "mesh/chunk_room.hpp"
#include "pipe/layer_source.hpp"
#include "process/figures.hpp"
#include "process/stage_list.hpp"
#include "process/window.hpp"

// A task extracts a window: its own layers and a halo below and above, which it makes anew. It
// applies the stages to the whole window and keeps its own part. A window cannot be divided, so all
// layers are counted before the work: tasks then have as many layers as memory allows, and each
// window knows which part of it is its own.

namespace mc::pipe {

namespace {

constexpr std::int32_t kBlockLayers = 8;    // layers of cells in a layer of blocks
constexpr std::int32_t kCountedLayers = 8;  // at once
constexpr std::int32_t kTasksAThread = 4;
constexpr std::int32_t kMaxHalos = 4;        // own layers that a task wants, in halos
constexpr std::int32_t kMaxMoreLayers = 32;  // and for halos that are thin
/// Bytes of a window in work for each byte of its mesh: while a buffer moves, it exists twice.
constexpr std::uint64_t kGrowth = 2;
constexpr std::uint64_t kTooManyBytes = std::uint64_t{1} << 50U;
constexpr std::uint64_t kMaxVertices = std::numeric_limits<std::uint32_t>::max();

/// Makes space for a window's mesh, so that its buffers need not move as they grow. Engines want
/// more at the end than they fill.
void reserve(const Counts& counts, Precision precision, bool has_normals, MeshChunk& chunk) {
  constexpr std::size_t kMore = std::size_t{1} << 18U;
  chunk.clear();
  const std::size_t n = 3 * counts.n_vertices + kMore;
  if (precision == Precision::f64) {
    chunk.positions_f64.reserve(n);
  } else {
    chunk.positions.reserve(n);
  }
  if (has_normals) chunk.normals.reserve(n);
  chunk.indices.reserve(3 * counts.n_triangles + kMore);
}

/// The halo of layers that are `thickness` cells thick. Below, the layer of cells next to the own
/// part must come out right: its triangles share edges with the own ones. Above, the vertices that
/// own triangles name must come out right; where counts change, all of that layer must, as ids
/// depend on it. The uppermost layer of cells lacks the vertices above it.
Halo halo_of(const process::StageList& stages, std::int64_t thickness) {
  const auto layers = [&](std::int64_t cells) {
    return static_cast<std::int32_t>(
        std::min<std::int64_t>((cells + thickness - 1) / thickness, 1 << 29));
  };
  const std::int64_t reach = stages.reach();
  return {layers(reach + 1), layers(reach + 2 + (stages.change_counts() ? thickness - 1 : 0))};
}

class WindowTasks final : public TaskList {
 public:
  WindowTasks(std::unique_ptr<LayerSource> source, std::int32_t thickness, const Volume& volume,
              const RunOptions& options)
      : source_(std::move(source)),
        stages_(options.stages),
        halo_(halo_of(stages_, thickness)),
        counted_(window_of(source_->own())),
        given_layers_((options.slab_layers + thickness - 1) / thickness),
        memory_bytes_(options.memory_bytes),
        precision_(options.extract.precision),
        has_normals_(stages_.with_normals(options.extract.normals != Normals::none)),
        vertex_bytes_(mesh::vertex_bytes(precision_, has_normals_)),
        measure_(options.extract.measure),
        origin_(options.extract.origin),
        apex_(cone_apex(volume, options)),
        before_(static_cast<std::size_t>(counted_.last - counted_.first) + 1) {}

  void plan(Progress& progress, const std::stop_token& stop) override;
  void fit(std::size_t n_slots, std::uint64_t bytes) override;
  void set_room(const Room& room) override;
  [[nodiscard]] std::size_t n_tasks() const override { return n_tasks_of(layers_); }
  [[nodiscard]] std::uint64_t samples(std::size_t n) const override {
    return source_->samples(own_of(n, layers_));
  }
  void make(std::size_t n, std::size_t slot, TaskResult& out) override;
  void count(std::size_t n, std::size_t slot, TaskResult& out) override;
  [[nodiscard]] std::optional<Counts> known_counts() const override {
    if (stages_.change_counts()) return std::nullopt;
    return counts_of(source_->own());
  }
  [[nodiscard]] bool has_pieces() const override { return false; }
  std::size_t next_pieces(std::size_t /*slot*/) override { return 0; }
  void make_piece(std::size_t /*piece*/, std::size_t /*maker*/, TaskResult& /*out*/) override {
    assert(false);
  }
  [[nodiscard]] std::uint64_t held_bytes(std::size_t n_slots,
                                         std::size_t /*n_makers*/) const override {
    return before_.size() * sizeof(Counts) + source_->held_bytes(n_slots, window_layers()) +
           n_slots * window_bytes(layers_);
  }
  [[nodiscard]] std::uint64_t input_bytes() const override { return source_->input_bytes(); }
  [[nodiscard]] std::uint64_t least_chunk_bytes() const override { return own_bytes(); }
  [[nodiscard]] std::uint64_t smooth_content_bytes() const override { return own_bytes(); }
  [[nodiscard]] std::uint64_t most_content_bytes() const override { return own_bytes(); }

 private:
  [[nodiscard]] std::size_t n_tasks_of(std::int32_t n_layers) const {
    const LayerRange own = source_->own();
    return static_cast<std::size_t>((std::int64_t{own.last} - own.first + n_layers - 1) / n_layers);
  }
  [[nodiscard]] LayerRange own_of(std::size_t n, std::int32_t n_layers) const {
    const std::int32_t first = source_->own().first + static_cast<std::int32_t>(n) * n_layers;
    return {first, first + std::min(source_->own().last - first, n_layers)};
  }
  [[nodiscard]] LayerRange window_of(const LayerRange& own) const {
    const LayerRange all = source_->all();
    return {own.first - std::min(halo_.below, own.first - all.first),
            own.last + std::min(halo_.above, all.last - own.last)};
  }
  /// Layers of the largest window.
  [[nodiscard]] std::int32_t window_layers() const {
    const LayerRange all = source_->all();
    return static_cast<std::int32_t>(
        std::min(std::int64_t{layers_} + halo_.n_layers(), std::int64_t{all.last} - all.first));
  }
  /// What lies before a layer, from the first counted layer on.
  [[nodiscard]] const Counts& before(std::int32_t layer) const {
    return before_[static_cast<std::size_t>(layer - counted_.first)];
  }
  [[nodiscard]] Counts counts_of(const LayerRange& layers) const {
    const Counts& a = before(layers.first);
    const Counts& b = before(layers.last);
    return {b.n_vertices - a.n_vertices, b.n_triangles - a.n_triangles,
            b.n_boundary_edges - a.n_boundary_edges};
  }
  [[nodiscard]] std::uint64_t content_bytes(const Counts& counts) const {
    return mesh::content_bytes(counts.n_vertices, counts.n_triangles, vertex_bytes_);
  }
  [[nodiscard]] std::uint64_t window_bytes(std::int32_t n_layers) const;
  [[nodiscard]] std::uint64_t own_bytes() const;
  [[nodiscard]] std::int32_t layers_wanted() const;
  [[nodiscard]] std::int32_t min_layers(std::size_t n_slots) const;
  [[nodiscard]] MeshWindow extract(const LayerRange& own, std::size_t slot, TaskResult& out);
  void take_figures(const MeshWindow& window, const LayerRange& own, TaskTotals& totals) const;

  std::unique_ptr<LayerSource> source_;
  process::StageList stages_;
  Halo halo_;
  LayerRange counted_;  ///< the own layers with their halo
  std::int32_t given_layers_;
  std::uint64_t memory_bytes_;
  Precision precision_;
  bool has_normals_;  ///< at some time between extraction and sink
  std::uint64_t vertex_bytes_;
  bool measure_;
  Vec3 origin_, apex_;
  std::vector<Counts> before_;  ///< of each counted layer and of the end; zeros before plan()
  std::int32_t layers_ = 1;     ///< own layers of a task
  Counts largest_;              ///< most vertices and most triangles of a window
};

/// Counts every layer that a window will have.
void WindowTasks::plan(Progress& progress, const std::stop_token& stop) {
  const std::uint64_t bytes = memory_beside(source_->input_bytes(), memory_bytes_) / 2;
  std::size_t n_slots = base::pipeline_slots();
  while (n_slots > 1 && source_->held_bytes(n_slots, kCountedLayers) > bytes) n_slots /= 2;
  const std::int32_t n_at_once =
      source_->held_bytes(n_slots, kCountedLayers) > bytes ? 1 : kCountedLayers;
  const auto layers_of = [&](std::size_t n) {
    const std::int32_t first = counted_.first + static_cast<std::int32_t>(n) * n_at_once;
    return LayerRange{first, first + std::min(counted_.last - first, n_at_once)};
  };
  source_->set_slots(n_slots);
  progress.begin("count", source_->samples(counted_), "samples");
  const std::array<base::Step, 2> steps{{
      {false,
       [&](std::size_t n, std::size_t slot) {
         if (stop.stop_requested()) throw Cancelled();
         const LayerRange layers = layers_of(n);
         source_->count(
             layers, slot,
             std::span(before_).subspan(static_cast<std::size_t>(layers.first - counted_.first) + 1,
                                        static_cast<std::size_t>(layers.last - layers.first)));
       }},
      {true, [&](std::size_t n,
                 std::size_t /*slot*/) { progress.advance(source_->samples(layers_of(n))); }},
  }};
  const std::size_t n_layers = before_.size() - 1;
  const auto step = static_cast<std::size_t>(n_at_once);
  base::pipeline((n_layers + step - 1) / step, n_slots, steps);
  for (std::size_t n = 1; n < before_.size(); ++n) {
    before_[n].n_vertices += before_[n - 1].n_vertices;
    before_[n].n_triangles += before_[n - 1].n_triangles;
    before_[n].n_boundary_edges += before_[n - 1].n_boundary_edges;
  }
  if (window_bytes(1) >= kTooManyBytes) {
    throw Error(ErrorKind::limit, stages_.window_names(),
                "one layer and its halo have 2^32 vertices", Remedy::smaller_region);
  }
}

/// The most that one window takes in work, of tasks with so many own layers.
std::uint64_t WindowTasks::window_bytes(std::int32_t n_layers) const {
  const bool finds_edges = stages_.change_counts();
  const std::uint64_t vertex =
      stages_.vertex_bytes() + (finds_edges ? process::kEdgeVertexBytes : 0);
  const std::uint64_t triangle =
      stages_.triangle_bytes() + (finds_edges ? process::kEdgeTriangleBytes : 0);
  std::uint64_t most = 0;
  for (std::size_t n = 0; n < n_tasks_of(n_layers); ++n) {
    const Counts counts = counts_of(window_of(own_of(n, n_layers)));
    if (counts.n_vertices > kMaxVertices) return kTooManyBytes;
    most = std::max(most, kGrowth * content_bytes(counts) + vertex * counts.n_vertices +
                              triangle * counts.n_triangles);
  }
  return most;
}

/// Bytes of the largest own part.
std::uint64_t WindowTasks::own_bytes() const {
  std::uint64_t most = 0;
  for (std::size_t n = 0; n < n_tasks(); ++n) {
    most = std::max(most, content_bytes(counts_of(own_of(n, layers_))));
  }
  return most;
}

/// Enough own layers for the halo to cost little, if all threads have work then.
std::int32_t WindowTasks::layers_wanted() const {
  const std::int64_t halo = halo_.n_layers();
  const std::int64_t n_own = std::int64_t{source_->own().last} - source_->own().first;
  const std::int64_t share = n_own / (std::int64_t{kTasksAThread} * base::thread_count());
  const std::int64_t wanted = std::clamp(share, halo, kMaxHalos * halo + kMaxMoreLayers);
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(n_own, 1, wanted));
}

/// Own layers that each of `n_slots` tasks at once must have. With thinner tasks, more of the mesh
/// is made twice than several tasks at once gain.
std::int32_t WindowTasks::min_layers(std::size_t n_slots) const {
  if (n_slots == 1) return 1;
  const bool more_than_threads = n_slots > static_cast<std::size_t>(base::thread_count());
  return more_than_threads ? halo_.n_layers() : (halo_.n_layers() + 1) / 2;
}

void WindowTasks::fit(std::size_t n_slots, std::uint64_t bytes) {
  layers_ = given_layers_;
  if (given_layers_ > 0) return;
  layers_ = layers_wanted();
  const std::int32_t least = std::min(layers_, min_layers(n_slots));
  while (layers_ > least && held_bytes(n_slots, 0) > bytes) {
    layers_ = std::max(least, layers_ - (layers_ + 3) / 4);
  }
}

void WindowTasks::set_room(const Room& room) {
  source_->set_slots(room.n_slots);
  largest_ = {};
  for (std::size_t n = 0; n < n_tasks(); ++n) {
    const Counts counts = counts_of(window_of(own_of(n, layers_)));
    largest_.n_vertices = std::max(largest_.n_vertices, counts.n_vertices);
    largest_.n_triangles = std::max(largest_.n_triangles, counts.n_triangles);
  }
}

MeshWindow WindowTasks::extract(const LayerRange& own, std::size_t slot, TaskResult& out) {
  const LayerRange layers = window_of(own);
  reserve(largest_, precision_, has_normals_, out.chunk);
  source_->extract(layers, slot, out);
  MeshWindow window{out.chunk, origin_, {}, {}};
  assert(out.chunk.n_vertices() == counts_of(layers).n_vertices);
  assert(out.chunk.n_triangles() == counts_of(layers).n_triangles);
  const Counts below = counts_of({layers.first, own.first});
  const Counts middle = counts_of(own);
  window.own_vertices = {below.n_vertices, below.n_vertices + middle.n_vertices};
  window.own_triangles = {below.n_triangles, below.n_triangles + middle.n_triangles};
  process::drop_incomplete_triangles(out.chunk,
                                     counts_of({layers.first, layers.last - 1}).n_triangles);
  return window;
}

/// Before the window is cropped: figures of its own part that depend on the halo.
void WindowTasks::take_figures(const MeshWindow& window, const LayerRange& own,
                               TaskTotals& totals) const {
  totals.n_vertices = window.own_vertices.size();
  totals.n_triangles = window.own_triangles.size();
  totals.n_boundary_edges = stages_.change_counts() ? process::own_boundary_edges(window)
                                                    : counts_of(own).n_boundary_edges;
  totals.sums.reset();
  if (measure_) totals.sums = process::own_sums(window, apex_);
}

void WindowTasks::make(std::size_t n, std::size_t slot, TaskResult& out) {
  const LayerRange own = own_of(n, layers_);
  MeshWindow window = extract(own, slot, out);
  stages_.apply(window);
  take_figures(window, own, out.totals);
  process::crop_to_own(window);
  out.totals.bounds = process::bounds_of(out.chunk);
  out.complete = true;
}

void WindowTasks::count(std::size_t n, std::size_t slot, TaskResult& out) {
  if (stages_.change_counts()) return make(n, slot, out);
  const Counts counts = counts_of(own_of(n, layers_));
  out.totals.n_vertices = counts.n_vertices;
  out.totals.n_triangles = counts.n_triangles;
  out.totals.n_boundary_edges = counts.n_boundary_edges;
}

}  // namespace

std::unique_ptr<TaskList> dense_window_tasks(const PlaneInput& input, const RunOptions& options) {
  return std::make_unique<WindowTasks>(dense_layer_source(input, options), 1, input.volume(),
                                       options);
}

std::unique_ptr<TaskList> sparse_window_tasks(const LeafReader& reader, const RunOptions& options) {
  const Halo halo = halo_of(process::StageList(options.stages), kBlockLayers);
  return std::make_unique<WindowTasks>(sparse_layer_source(reader, halo, options), kBlockLayers,
                                       reader.volume(), options);
}

}  // namespace mc::pipe
