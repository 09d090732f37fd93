// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <limits>
#include <memory>
#include <vector>

#include "base/parallel.hpp"
#include "mc/method.hpp"
#include "mesh/chunk_room.hpp"
#include "pipe/dense_planes.hpp"
#include "pipe/tasks.hpp"

// Dense volumes: a task is a slab of cell layers; its pieces are bands of rows, layer by layer.

namespace mc::pipe {

namespace {

/// Samples that one slab should hold, so that its planes stay in a core's cache.
constexpr std::uint64_t kSlabSamples = 1U << 20U;
constexpr std::int32_t kMinLayers = 4;   // fewer would read the shared planes too often
constexpr std::int32_t kMaxLayers = 64;  // more would leave threads idle at the end

// Where a plane costs more to make than to move, few are made twice, for the slabs on both sides.
constexpr std::int32_t kDearLayers = 61;  // 64 planes
constexpr std::uint64_t kDearSlabBytes = 64U << 20U;
constexpr int kTasksAThread = 4;

// Layers that an estimate looks at: of a large volume, less than 2 % of the planes.
constexpr std::int64_t kLayersPerSample = 100;
constexpr std::int64_t kLeastSamples = 4;

class DenseTasks final : public TaskList {
 public:
  DenseTasks(const PlaneInput& input, const RunOptions& options)
      : planes_(input, options),
        method_(method_of(options.extract)),
        extract_(options.extract),
        to_world_(options.to_world.value_or(input.volume().lattice.to_world)),
        engine_(new_engine()),
        range_(chosen_layers(options.extract, {0, engine_->n_layers()})),
        given_layers_(options.slab_layers),
        shared_planes_(shared_planes(*engine_)) {
    fit(base::pipeline_slots(), std::numeric_limits<std::uint64_t>::max());
  }

  void fit(std::size_t n_slots, std::uint64_t bytes) override {
    layers_ = given_layers_ > 0 ? given_layers_ : layers_wanted(bytes / n_slots);
    if (!engine_->has_bands()) layers_ = 1;
    layers_ = std::min({layers_, engine_->max_layers(), engine_->n_layers()});
    const std::uint64_t n_planes =
        n_slots * static_cast<std::uint64_t>(layers_) + static_cast<std::uint64_t>(shared_planes_);
    copied_bytes_ = planes_.hold_copies(n_planes, bytes / 2);
  }
  void set_room(const Room& room) override {
    room_ = room;
    if (!engine_->has_bands()) {
      room_.chunk_bytes = std::max(room_.chunk_bytes, engine_->least_chunk_bytes());
    }
    slots_.clear();
    slots_.resize(room.n_slots);
    std::vector<SlabEngine*> engines;
    for (Slot& slot : slots_) {
      slot.engine = new_engine();
      engines.push_back(slot.engine.get());
    }
    engine_->share(engines);
    bands_.reset();
  }
  void forget() override { engine_->forget(); }
  [[nodiscard]] std::size_t n_tasks() const override {
    return static_cast<std::size_t>((range_.last - range_.first + layers_ - 1) / layers_);
  }
  [[nodiscard]] std::uint64_t samples(std::size_t n) const override {
    return planes_.n_samples * static_cast<std::uint64_t>(last(n) - first(n));
  }
  void fetch(std::size_t n, std::size_t slot) override {
    if (planes_.input.single_pass()) read(n, slots_[slot]);
  }
  void make(std::size_t n, std::size_t slot, TaskResult& out) override {
    Slot& s = slots_[slot];
    if (!planes_.input.single_pass()) read(n, s);
    const std::int32_t end =
        s.engine->extract(s.slab, first(n), last(n), room_.chunk_bytes, out.chunk, out.totals);
    out.complete = end == last(n);
    if (!out.complete) {
      assert(engine_->has_bands());
      s.rest = {end, last(n), end == first(n)};
      out.totals.n_vertices +=
          s.engine->count_vertices(s.slab, s.rest.first, s.rest.last, s.rest.with_lowest);
    }
    out.totals.n_asked = planes_.n_samples * s.slab.planes.size();
    out.totals.n_skipped = s.slab.sides.n_left_out();
  }
  std::size_t next_pieces(std::size_t slot) override {
    Rest& rest = slots_[slot].rest;
    if (!bands_) bands_ = engine_->bands(room_.n_makers);
    if (!rest.begun) {
      rest.begun = true;
      bands_->start(slots_[slot].slab, rest.first, rest.last, rest.with_lowest, room_.piece_bytes);
    }
    return bands_->next();
  }
  void make_piece(std::size_t piece, std::size_t maker, TaskResult& out) override {
    bands_->make(piece, maker, out.chunk, out.totals);
  }
  [[nodiscard]] std::optional<std::uint64_t> estimate_triangles() const override {
    ExtractOptions plain = extract_;  // needs only the two planes of a layer
    plain.normals = Normals::none;
    plain.measure = false;
    const auto engine = method_.dense(planes_.input.volume(), to_world_, plain);
    const std::int64_t n_layers = range_.last - range_.first;
    const std::int64_t n_seen =
        std::min(n_layers, std::max(n_layers / kLayersPerSample, kLeastSamples));
    std::uint64_t n_triangles = 0;
    SurfaceTotals layer_totals;
    Slab slab;
    for (std::int64_t n = 0; n < n_seen; ++n) {
      const auto layer =
          static_cast<std::int32_t>(range_.first + (2 * n + 1) * n_layers / (2 * n_seen));
      const auto [k0, k1] = engine->planes_for(layer, layer + 1);
      planes_.read(k0, k1, slab);
      engine->count(slab, layer, layer + 1, layer_totals);
      n_triangles += layer_totals.n_triangles;
    }
    return n_seen == 0 ? 0
                       : n_triangles * static_cast<std::uint64_t>(n_layers) /
                             static_cast<std::uint64_t>(n_seen);
  }
  void count(std::size_t n, std::size_t slot, TaskResult& out) override {
    Slot& s = slots_[slot];
    read(n, s);
    s.engine->count(s.slab, first(n), last(n), out.totals);
  }
  [[nodiscard]] std::uint64_t held_bytes(std::size_t n_slots, std::size_t n_makers) const override {
    const std::uint64_t slab =
        planes_.input.rereads_cheaply()
            ? 0
            : planes_.plane_bytes * static_cast<std::uint64_t>(layers_ + shared_planes_);
    return n_slots * (engine_->scratch_bytes() + slab) + copied_bytes_ +
           engine_->bands_bytes(n_makers);
  }
  [[nodiscard]] std::uint64_t input_bytes() const override { return planes_.input.held_bytes(); }
  [[nodiscard]] std::uint64_t least_chunk_bytes() const override {
    return engine_->least_chunk_bytes();
  }
  [[nodiscard]] std::uint64_t smooth_content_bytes() const override {
    // A flat surface through the slab: about a vertex and two triangles a column.
    return mesh::content_bytes(planes_.n_samples, 2 * planes_.n_samples, vertex_bytes());
  }
  [[nodiscard]] std::uint64_t most_content_bytes() const override {
    return engine_->max_mesh_bytes(layers_);
  }

 private:
  /// Layers whose surface a task's chunk could not hold.
  struct Rest {
    std::int32_t first = 0, last = 0;
    bool with_lowest = false;
    bool begun = false;
  };
  struct Slot {
    std::unique_ptr<SlabEngine> engine;
    Slab slab;
    Rest rest;
  };

  [[nodiscard]] std::unique_ptr<SlabEngine> new_engine() const {
    return method_.dense(planes_.input.volume(), to_world_, extract_);
  }
  [[nodiscard]] std::uint64_t vertex_bytes() const {
    return mesh::vertex_bytes(extract_.precision, extract_.normals != Normals::none);
  }
  [[nodiscard]] std::int32_t first(std::size_t n) const {
    return range_.first + static_cast<std::int32_t>(n) * layers_;
  }
  [[nodiscard]] std::int32_t last(std::size_t n) const {
    return std::min(range_.last - first(n), layers_) + first(n);
  }
  /// Layers of one task, whose planes are to take no more than `bytes` where they are copied.
  [[nodiscard]] std::int32_t layers_wanted(std::uint64_t bytes) const {
    const auto within = [](std::uint64_t v, std::int32_t lo, std::int32_t hi) {
      return static_cast<std::int32_t>(
          std::clamp<std::uint64_t>(v, std::uint64_t(lo), std::uint64_t(hi)));
    };
    const std::int32_t cached = within(kSlabSamples / planes_.n_samples, kMinLayers, kMaxLayers);
    if (planes_.input.rereads_cheaply()) return cached;
    const std::int32_t planes = within(bytes / planes_.plane_bytes, 0, kMaxLayers + shared_planes_);
    const std::int32_t most = std::max(planes - shared_planes_, 1);
    if (planes_.input.single_pass()) return std::min(cached, most);
    const auto n_parts =
        std::uint64_t{kTasksAThread} * static_cast<std::uint64_t>(base::thread_count());
    const auto share = static_cast<std::uint64_t>(range_.last - range_.first) / n_parts;
    const std::int32_t dear =
        within(std::min(kDearSlabBytes / planes_.plane_bytes, share), kMinLayers, kDearLayers);
    return std::min(std::max(cached, dear), most);
  }
  void read(std::size_t n, Slot& s) const {
    const auto [k0, k1] = engine_->planes_for(first(n), last(n));
    planes_.read(k0, k1, s.slab);
  }

  DensePlanes planes_;
  const Method& method_;
  ExtractOptions extract_;
  Affine to_world_;
  std::unique_ptr<SlabEngine> engine_;  ///< answers for all, and keeps what slots share
  LayerRange range_;
  std::int32_t given_layers_;
  std::int32_t shared_planes_;
  Room room_;
  std::vector<Slot> slots_;
  std::unique_ptr<SlabBands> bands_;  ///< made when first needed
  std::int32_t layers_ = 1;
  std::uint64_t copied_bytes_ = 0;  ///< planes that slots share
};

}  // namespace

std::unique_ptr<TaskList> dense_tasks(const PlaneInput& input, const RunOptions& options) {
  return std::make_unique<DenseTasks>(input, options);
}

LayerRange dense_layers(const Volume& volume, const RunOptions& options) {
  const Affine to_world = options.to_world.value_or(volume.lattice.to_world);
  return {0, method_of(options.extract).dense(volume, to_world, options.extract)->n_layers()};
}

}  // namespace mc::pipe
