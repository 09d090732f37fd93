// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <limits>
#include <memory>
#include <vector>

#include "mc/method.hpp"
#include "mesh/chunk_room.hpp"
#include "pipe/dense_planes.hpp"
#include "pipe/layer_source.hpp"

// Windows of a dense volume. A window is one slab, unless the method's slabs must be thinner.

namespace mc::pipe {

namespace {

constexpr std::uint32_t kMaxIndex = std::numeric_limits<std::uint32_t>::max();

/// Appends a chunk whose vertices follow those of `to`.
void append(const MeshChunk& from, MeshChunk& to) {
  const auto first = static_cast<std::uint32_t>(to.n_vertices());
  const auto add = [](const auto& some, auto& all) {
    all.insert(all.end(), some.begin(), some.end());
  };
  add(from.positions, to.positions);
  add(from.positions_f64, to.positions_f64);
  add(from.normals, to.normals);
  for (const std::uint32_t index : from.indices) {
    // An id past 32 bits names no vertex of the window: saturated, it still does not.
    to.indices.push_back(index + std::min(first, kMaxIndex - index));
  }
}

class DenseLayers final : public LayerSource {
 public:
  DenseLayers(const PlaneInput& input, const RunOptions& options)
      : planes_(input, options),
        method_(method_of(options.extract)),
        extract_(options.extract),
        to_world_(options.to_world.value_or(input.volume().lattice.to_world)) {
    extract_.measure = false;  // of the mesh before the stages
    engine_ = new_engine();
    own_ = chosen_layers(options.extract, all());
  }

  [[nodiscard]] LayerRange all() const override { return {0, engine_->n_layers()}; }
  [[nodiscard]] LayerRange own() const override { return own_; }
  [[nodiscard]] std::uint64_t samples(const LayerRange& layers) const override {
    return planes_.n_samples * static_cast<std::uint64_t>(layers.last - layers.first);
  }
  void set_slots(std::size_t n_slots) override {
    slots_.clear();
    slots_.resize(n_slots);
    for (Slot& slot : slots_) slot.engine = new_engine();
  }
  void count(const LayerRange& layers, std::size_t slot, std::span<Counts> out) override {
    Slot& s = slots_[slot];
    read(layers, s.slab);
    SurfaceTotals totals;
    for (std::int32_t l = layers.first; l < layers.last; ++l) {
      s.engine->count(s.slab, l, l + 1, totals);
      out[static_cast<std::size_t>(l - layers.first)] = {totals.n_vertices, totals.n_triangles,
                                                         totals.n_boundary_edges};
    }
  }
  void extract(const LayerRange& layers, std::size_t slot, TaskResult& out) override {
    Slot& s = slots_[slot];
    read(layers, s.slab);
    const std::int32_t n_at_once = engine_->has_bands() ? engine_->max_layers() : 1;
    if (layers.last - layers.first <= n_at_once) {
      extract_run(layers, s, out.chunk, out.totals);
    } else {
      out.chunk.clear();
      for (std::int32_t l = layers.first; l < layers.last; l += n_at_once) {
        extract_run({l, std::min(layers.last, l + n_at_once)}, s, s.run, out.totals);
        append(s.run, out.chunk);
      }
    }
    out.totals.n_asked = planes_.n_samples * s.slab.planes.size();
    out.totals.n_skipped = s.slab.sides.n_left_out();
  }
  [[nodiscard]] std::uint64_t held_bytes(std::size_t n_slots,
                                         std::int32_t n_layers) const override {
    const std::uint64_t slab =
        planes_.input.rereads_cheaply()
            ? 0
            : planes_.plane_bytes * static_cast<std::uint64_t>(n_layers + shared_planes(*engine_));
    const std::uint64_t run = engine_->has_bands() ? 0 : engine_->least_chunk_bytes();
    return n_slots * (engine_->scratch_bytes() + slab + run);
  }
  [[nodiscard]] std::uint64_t input_bytes() const override { return planes_.input.held_bytes(); }

 private:
  struct Slot {
    std::unique_ptr<SlabEngine> engine;
    Slab slab;
    MeshChunk run;
  };

  [[nodiscard]] std::unique_ptr<SlabEngine> new_engine() const {
    return method_.dense(planes_.input.volume(), to_world_, extract_);
  }
  void read(const LayerRange& layers, Slab& slab) const {
    const auto [k0, k1] = engine_->planes_for(layers.first, layers.last);
    planes_.read(k0, k1, slab);
  }
  static void extract_run(const LayerRange& layers, Slot& s, MeshChunk& chunk,
                          SurfaceTotals& totals) {
    [[maybe_unused]] const std::int32_t end = s.engine->extract(
        s.slab, layers.first, layers.last, mesh::ChunkRoom::kUnlimited, chunk, totals);
    assert(end == layers.last);
  }

  DensePlanes planes_;
  const Method& method_;
  ExtractOptions extract_;
  Affine to_world_;
  std::unique_ptr<SlabEngine> engine_;  ///< answers for all
  LayerRange own_;
  std::vector<Slot> slots_;
};

}  // namespace

std::unique_ptr<LayerSource> dense_layer_source(const PlaneInput& input,
                                                const RunOptions& options) {
  return std::make_unique<DenseLayers>(input, options);
}

}  // namespace mc::pipe
