// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <memory>
#include <optional>
#include <vector>

#include "mc/method.hpp"
#include "mesh/chunk_room.hpp"
#include "pipe/layer_source.hpp"

// Windows of a sparse volume. A layer is all blocks of one index along k; layers count those that
// have blocks, so that a volume of few blocks far apart has few layers. A halo of so many layers
// then reaches at least as far as the same number of layers of the lattice.

namespace mc::pipe {

namespace {

RunOptions with_halo(const RunOptions& options, const Halo& halo, const LayerRange& all) {
  RunOptions out = options;
  out.extract.measure = false;  // of the mesh before the stages
  if (options.extract.part) {
    const LayerRange own = chosen_layers(options.extract, all);
    out.extract.part = LayerRange{own.first - std::min(halo.below, own.first - all.first),
                                  own.last + std::min(halo.above, all.last - own.last)};
  }
  return out;
}

class SparseLayers final : public LayerSource {
 public:
  SparseLayers(const LeafReader& reader, const Halo& halo, const RunOptions& options)
      : reader_(reader),
        engine_(block_engine(reader, with_halo(options, halo, sparse_layers(reader, options)))) {
    list_layers(options.extract.part);
  }

  [[nodiscard]] LayerRange all() const override {
    return {0, static_cast<std::int32_t>(first_.size() - 1)};
  }
  [[nodiscard]] LayerRange own() const override { return own_; }
  [[nodiscard]] std::uint64_t samples(const LayerRange& layers) const override {
    return (first(layers.last) - first(layers.first)) * LeafReader::kLeafSamples;
  }
  void set_slots(std::size_t n_slots) override {
    workers_.clear();
    workers_.resize(n_slots);
    for (std::unique_ptr<BlockWorker>& worker : workers_) worker = engine_->worker();
  }
  void count(const LayerRange& layers, std::size_t slot, std::span<Counts> out) override {
    SurfaceTotals totals;
    for (std::int32_t l = layers.first; l < layers.last; ++l) {
      workers_[slot]->count(first(l), first(l + 1), totals);
      out[static_cast<std::size_t>(l - layers.first)] = {totals.n_vertices, totals.n_triangles,
                                                         totals.n_boundary_edges};
    }
  }
  void extract(const LayerRange& layers, std::size_t slot, TaskResult& out) override {
    [[maybe_unused]] const std::size_t end =
        workers_[slot]->extract(first(layers.first), first(layers.last),
                                mesh::ChunkRoom::kUnlimited, out.chunk, out.totals);
    assert(end == first(layers.last));
  }
  [[nodiscard]] std::uint64_t held_bytes(std::size_t n_slots,
                                         std::int32_t /*n_layers*/) const override {
    return engine_->plan_bytes() + first_.size() * sizeof(std::size_t) +
           n_slots * engine_->worker_bytes();
  }
  [[nodiscard]] std::uint64_t input_bytes() const override { return reader_.held_bytes(); }

 private:
  void list_layers(const std::optional<LayerRange>& part) {
    const std::size_t n_blocks = engine_->n_blocks();
    for (std::size_t n = 0; n < n_blocks; ++n) {
      if (n == 0 || engine_->layer(n) != engine_->layer(n - 1)) first_.push_back(n);
    }
    const auto n_below = [&](std::int32_t layer) {
      return static_cast<std::int32_t>(std::ranges::count_if(
          first_, [&](std::size_t block) { return engine_->layer(block) < layer; }));
    };
    own_ = part ? LayerRange{n_below(part->first), n_below(part->last)}
                : LayerRange{0, static_cast<std::int32_t>(first_.size())};
    first_.push_back(n_blocks);
  }
  [[nodiscard]] std::size_t first(std::int32_t layer) const {
    return first_[static_cast<std::size_t>(layer)];
  }

  const LeafReader& reader_;
  std::unique_ptr<BlockEngine> engine_;
  std::vector<std::size_t> first_;  ///< block of each layer, and the number of all
  LayerRange own_;
  std::vector<std::unique_ptr<BlockWorker>> workers_;
};

}  // namespace

std::unique_ptr<LayerSource> sparse_layer_source(const LeafReader& reader, const Halo& halo,
                                                 const RunOptions& options) {
  return std::make_unique<SparseLayers>(reader, halo, options);
}

}  // namespace mc::pipe
