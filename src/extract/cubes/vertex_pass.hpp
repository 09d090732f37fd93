// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <tuple>

#include "extract/cubes/dense_grid.hpp"
#include "extract/cubes/slab_sampler.hpp"
#include "extract/cubes/vertex_writer.hpp"
#include "mesh/chunk_room.hpp"

// From listed edges of dense planes to vertices in a chunk.

namespace mc::extraction {

/// Edges waiting for their vertices, for either kind of arithmetic. Scratch: keeps its memory.
using EdgeBatches = std::tuple<EdgeBatch<float>, EdgeBatch<double>>;

/// Bytes of it for one volume.
inline std::uint64_t edge_batch_bytes(const DenseGrid& grid) {
  return (list_room(grid.classifier.row_samples()) + EdgeBatch<double>::kEnough) *
         EdgeBatch<double>::kBytesAnEdge;
}

/// Makes vertices of one slab until the chunk is full.
template <class T, bool Swap>
class VertexPass {
 public:
  using R = Real<T>;
  using Sampler = SlabSampler<T, Swap>;

  VertexPass(const DenseGrid& grid, const Slab& slab, EdgeBatches& batches, mesh::ChunkRoom& room,
             Bounds& bounds)
      : rules_(grid.options, grid.to_world, grid.classifier.threshold()),
        sampler_(slab, grid.classifier.box()),
        vertices_(rules_, sampler_),
        batch_(std::get<EdgeBatch<R>>(batches)),
        room_(room),
        writer_(rules_, sampler_, grid.options.precision, batch_, room.chunk(), bounds),
        gatherer_(slab, sampler_, vertices_, writer_.wants_gradients()) {
    batch_.reserve(list_room(grid.classifier.row_samples()) + EdgeBatch<R>::kEnough,
                   writer_.wants_gradients());
    list.first = grid.classifier.first_of(0);
    list_behind();
  }

  [[nodiscard]] const EdgeVertices<T, Sampler>& vertices() const { return vertices_; }
  [[nodiscard]] bool full() const { return full_; }
  void set_full() { full_ = true; }

  /// Takes the edges that were listed, which start in plane k of the lattice. Their vertices are
  /// made when there are enough of them, or by flush(); none once the chunk is full.
  void take(std::int32_t k) {
    if (list.n == 0) return;
    assert(list.n <= list.room);
    const std::size_t first = batch_.n;
    batch_.n += list.n;
    std::fill_n(batch_.k.begin() + static_cast<std::ptrdiff_t>(first), list.n, k);
    batch_.pad_places();
    gatherer_.gather(batch_, first, k, rules_.capped);
    list_behind();
    if (batch_.n >= EdgeBatch<R>::kEnough) flush();
  }

  /// Makes the vertices of all edges that were taken.
  void flush() {
    if (batch_.n == 0) return;
    full_ = full_ || !room_.make_for_vertices(batch_.n + kEdgesAtOnce);
    if (!full_) {
      batch_.pad_samples(writer_.wants_gradients());
      writer_.flush_padded();
    }
    batch_.n = 0;
    list_behind();
  }

  EdgeList list;

 private:
  /// Edges are listed behind those that wait. There are never so many that a row has no room.
  void list_behind() {
    list.room = batch_.room() - batch_.n;
    list.i = batch_.i.data() + batch_.n;
    list.j = batch_.j.data() + batch_.n;
    list.axis = batch_.axis.data() + batch_.n;
  }

  VertexRules<T> rules_;
  Sampler sampler_;
  EdgeVertices<T, Sampler> vertices_;
  EdgeBatch<R>& batch_;
  mesh::ChunkRoom& room_;
  VertexWriter<T, Sampler> writer_;
  SlabGatherer<T, Swap> gatherer_;
  bool full_ = false;
};

/// Takes the edges of rows [j, j_end) of a plane, in the order of their vertices' ids, and numbers
/// them from `next` on. Returns the id after the last.
template <class Pass>
std::uint32_t write_plane(const BitPlane& plane, std::int32_t k, std::size_t j, std::size_t j_end,
                          std::uint32_t next, const PlaneIds& ids, Pass& pass) {
  while (j < j_end && !pass.full()) {
    j = list_plane(plane, j, j_end, next, ids, pass.list);
    pass.take(k);
  }
  return next;
}

/// The same for the edges between two planes, which start in plane k.
template <class Pass>
std::uint32_t write_between(const BitPlane& lower, const BitPlane& upper, std::int32_t k,
                            std::size_t j, std::size_t j_end, std::uint32_t next,
                            std::uint32_t* k_ids, Pass& pass) {
  while (j < j_end && !pass.full()) {
    j = list_between(lower, upper, j, j_end, next, k_ids, pass.list);
    pass.take(k);
  }
  return next;
}

}  // namespace mc::extraction
