// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "mc/pipe.hpp"
#include "pipe/plane_input.hpp"
#include "pipe/tasks.hpp"

// What windows are made of: layers of a surface, dense or sparse, which can be extracted in any
// order, and again.

namespace mc::pipe {

/// Layers on both sides of a task's own that a window needs for its stages.
struct Halo {
  std::int32_t below = 0, above = 0;

  [[nodiscard]] std::int32_t n_layers() const { return below + above; }
};

/// Layers of a surface, in the order of the mesh. Triangles of a layer name vertices of that layer
/// and of the next one only. Each slot serves one thread.
class LayerSource {
 public:
  virtual ~LayerSource() = default;
  /// Layers that can be extracted, and those of them that the run makes.
  [[nodiscard]] virtual LayerRange all() const = 0;
  [[nodiscard]] virtual LayerRange own() const = 0;
  /// Samples of layers, for progress.
  [[nodiscard]] virtual std::uint64_t samples(const LayerRange& layers) const = 0;

  /// Makes scratch; before the functions below.
  virtual void set_slots(std::size_t n_slots) = 0;
  /// Counts each of the layers.
  virtual void count(const LayerRange& layers, std::size_t slot, std::span<Counts> out) = 0;
  /// Extracts layers into one chunk, whatever its size, with index_base 0. Of the totals, only the
  /// samples that were asked for and skipped mean something.
  virtual void extract(const LayerRange& layers, std::size_t slot, TaskResult& out) = 0;

  /// Bytes that windows of so many layers hold beside their mesh.
  [[nodiscard]] virtual std::uint64_t held_bytes(std::size_t n_slots,
                                                 std::int32_t n_layers) const = 0;
  /// Bytes that the input holds.
  [[nodiscard]] virtual std::uint64_t input_bytes() const = 0;
};

/// Layers of cells. Errors   as dense_tasks().
std::unique_ptr<LayerSource> dense_layer_source(const PlaneInput& input, const RunOptions& options);
/// Layers of blocks, those without a surface left out; with options.extract.part, as far above and
/// below it as `halo` says. Errors   as sparse_tasks().
std::unique_ptr<LayerSource> sparse_layer_source(const LeafReader& reader, const Halo& halo,
                                                 const RunOptions& options);

}  // namespace mc::pipe
