// SPDX-License-Identifier: MIT
#include "extract/cubes/dense.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "extract/cubes/dense_bands.hpp"
#include "extract/cubes/triangle_kernels.hpp"

namespace mc::extraction {

namespace {

/// Samples of a plane are counted up to this number, whose mesh no budget holds.
constexpr std::uint64_t kMaxCountedSamples = std::uint64_t{1} << 42U;

/// How far a chunk is complete.
struct Mark {
  std::size_t n_vertices = 0, n_indices = 0;
  Bounds bounds;

  Mark() = default;
  Mark(const MeshChunk& chunk, const Bounds& of)
      : n_vertices(chunk.n_vertices()), n_indices(chunk.indices.size()), bounds(of) {}

  /// Drops what came later.
  void restore(MeshChunk& chunk, Bounds& of) const {
    const auto cut = [](auto& buffer, std::size_t n) { buffer.resize(std::min(buffer.size(), n)); };
    cut(chunk.positions, 3 * n_vertices);
    cut(chunk.positions_f64, 3 * n_vertices);
    cut(chunk.normals, 3 * n_vertices);
    cut(chunk.indices, n_indices);
    of = bounds;
  }
};

[[maybe_unused]] bool holds(const Slab& slab, const std::pair<std::int32_t, std::int32_t>& planes) {
  return slab.k0 <= planes.first &&
         planes.second <= slab.k0 + static_cast<std::int64_t>(slab.planes.size());
}

}  // namespace

DenseExtractor::DenseExtractor(DenseGrid grid) : grid_(std::move(grid)) {}

/// Allocates when the first slab comes: engines that only answer questions need no planes.
void DenseExtractor::shape_planes() {
  if (shaped_) return;
  shaped_ = true;
  for (PlaneBits& plane : planes_) grid_.classifier.shape(plane);
  k_start_.resize(grid_.classifier.n_rows());
}

void DenseExtractor::set_box(const IndexBox& cells) {
  grid_.set_part(cells);
  shaped_ = false;
}

std::uint64_t DenseExtractor::scratch_bytes() const {
  // Three planes of its own and two that it shares.
  const PlaneClassifier& planes = grid_.classifier;
  return 5 * planes.plane_bytes() + 7 * planes.n_rows() * sizeof(std::uint32_t) +
         edge_batch_bytes(grid_);
}

std::uint64_t DenseExtractor::max_mesh_bytes(std::int32_t n_layers) const {
  const IndexBox& box = grid_.classifier.box();
  const auto plane = static_cast<std::uint64_t>(box.extent(0) * box.extent(1));
  const std::uint64_t cells =
      std::min(plane, kMaxCountedSamples) * static_cast<std::uint64_t>(n_layers + 1);
  const ExtractOptions& o = grid_.options;
  return mesh::content_bytes(3 * cells, kMaxTriangles * cells,
                             mesh::vertex_bytes(o.precision, o.normals != Normals::none));
}

std::uint64_t DenseExtractor::least_chunk_bytes() const { return DenseBands::least_bytes(grid_); }

std::unique_ptr<SlabBands> DenseExtractor::bands(std::size_t n_makers) const {
  return std::make_unique<DenseBands>(grid_, n_makers);
}

std::uint64_t DenseExtractor::bands_bytes(std::size_t n_makers) const {
  return DenseBands::scratch_bytes(grid_, n_makers);
}

void DenseExtractor::share(std::span<SlabEngine* const> others) {
  own_shared_.reset(2 * (others.size() + 1));
  for (SlabEngine* other : others) {
    assert(dynamic_cast<DenseExtractor*>(other) != nullptr);
    static_cast<DenseExtractor*>(other)->shared_ = &own_shared_;
  }
}

/// Makes the bits of a plane. One that slabs share may have been made for another.
void DenseExtractor::load(const Slab& slab, std::int32_t plane, SharedPlanes* shared) {
  PlaneBits& out = bits(plane);
  if (shared == nullptr || !shared->take(plane, out.words)) {
    grid_.classifier.classify(slab, plane, 0, grid_.classifier.n_rows(), out);
    grid_.select(plane, out);
    if (shared != nullptr) shared->offer(plane, out.words);
  }
  grid_.classifier.take_columns(out);
}

template <class Pass>
std::uint32_t DenseExtractor::write_plane_of(std::int32_t plane, std::uint32_t next, Pass& pass) {
  return write_plane(view(plane), grid_.classifier.first_of(plane)[2], 0, grid_.classifier.n_rows(),
                     next, bits(plane).ids(), pass);
}

/// Makes the vertices between planes `layer` and layer + 1. On the way makes the bits of plane
/// `coming`, a band of rows before the vertices there are made: so its samples come from memory in
/// several streams, and are still in the cache when they are interpolated.
template <class Pass>
std::uint32_t DenseExtractor::write_above(std::int32_t layer, const Slab& slab, std::int32_t coming,
                                          std::uint32_t next, Pass& pass) {
  const std::size_t n_rows = grid_.classifier.n_rows();
  const std::size_t band = grid_.classifier.rows_at_once();
  const std::int32_t k = grid_.classifier.first_of(layer)[2];
  for (std::size_t j = 0; j < n_rows && !pass.full(); j += band) {
    const std::size_t end = std::min(n_rows, j + band);
    if (coming != kNoPlane) grid_.classifier.classify(slab, coming, j, end, bits(coming));
    next = write_between(view(layer), view(layer + 1), k, j, end, next, k_start_.data(), pass);
  }
  return next;
}

template <class Pass>
void DenseExtractor::emit_layer(std::int32_t layer, mesh::ChunkRoom& room, Pass& pass) {
  // Room is made for a run of rows at a time: what is not used is given back at once.
  const std::size_t row_samples = grid_.classifier.row_samples();
  const std::size_t n_rows = grid_.classifier.n_rows();
  const std::size_t rows_at_once = std::max<std::size_t>(1, 16384 / row_samples);
  const CellLayer cells{view(layer), view(layer + 1), bits(layer).row_ids(),
                        bits(layer + 1).row_ids(), k_start_.data()};
  Buffer<std::uint32_t>& indices = room.chunk().indices;
  for (std::size_t j = 0; j + 1 < n_rows && !pass.full(); j += rows_at_once) {
    const std::size_t end = std::min(n_rows - 1, j + rows_at_once);
    const std::size_t before = indices.size();
    const std::size_t most = (end - j) * row_samples * 3 * kMaxTriangles + kEmitSlack;
    if (!room.make_for_indices(most)) return pass.set_full();
    indices.resize(before + most);
    const std::size_t n =
        emit_triangles(cells, j, end, grid_.placement.flip, indices.data() + before);
    indices.resize(before + n);
  }
}

/// Makes what lies between planes `layer` and layer + 1, and the vertices in the upper one if they
/// are the slab's. Returns the id after the last.
template <class Pass>
std::uint32_t DenseExtractor::make_layer(const Slab& slab, std::int32_t layer, std::int32_t l1,
                                         std::uint32_t next, mesh::ChunkRoom& room, Pass& pass) {
  std::int32_t coming = layer + 1 + grid_.reach();
  SharedPlanes* const shared = coming >= l1 ? shared_ : nullptr;
  if (coming >= grid_.n_planes()) {
    coming = kNoPlane;
  } else if (grid_.options.selection != nullptr) {
    load(slab, coming, shared);  // components are left out of whole planes only
    coming = kNoPlane;
  } else if (shared != nullptr && shared->take(coming, bits(coming).words)) {
    coming = kNoPlane;
  }
  next = write_above(layer, slab, coming, next, pass);
  if (pass.full()) return next;
  if (coming != kNoPlane && shared != nullptr) shared->offer(coming, bits(coming).words);
  grid_.classifier.take_columns(bits(layer + 1));
  next = owns(layer + 1, l1) ? write_plane_of(layer + 1, next, pass)
                             : number_plane(view(layer + 1), next, bits(layer + 1).ids());
  pass.flush();
  if (!pass.full()) emit_layer(layer, room, pass);
  return next;
}

template <class T, bool Swap>
std::int32_t DenseExtractor::extract_typed(const Slab& slab, std::int32_t l0, std::int32_t l1,
                                           mesh::ChunkRoom& room, SurfaceTotals& totals) {
  VertexPass<T, Swap> pass(grid_, slab, batches_, room, totals.bounds);
  for (std::int32_t plane = l0; plane <= l0 + grid_.reach(); ++plane) {
    load(slab, plane, shared_);
  }
  Mark complete;
  std::uint32_t next = write_plane_of(l0, 0, pass);
  std::int32_t layer = l0;
  for (; layer < l1 && !pass.full(); ++layer) {
    next = make_layer(slab, layer, l1, next, room, pass);
    if (pass.full()) break;
    totals.n_boundary_edges += grid_.border_sides(bits(layer), bits(layer + 1), layer);
    if (grid_.options.measure) {
      totals.layers.push_back(grid_.measure(view(layer), view(layer + 1), layer, pass.vertices()));
    }
    complete = {room.chunk(), totals.bounds};
  }
  if (pass.full()) complete.restore(room.chunk(), totals.bounds);
  return layer;
}

std::int32_t DenseExtractor::extract(const Slab& slab, std::int32_t l0, std::int32_t l1,
                                     std::uint64_t max_bytes, MeshChunk& chunk,
                                     SurfaceTotals& totals) {
  assert(0 <= l0 && l0 < l1 && l1 <= grid_.n_layers && l1 - l0 <= grid_.max_layers());
  assert(holds(slab, planes_for(l0, l1)));
  chunk.clear();
  totals.clear();
  shape_planes();
  mesh::ChunkRoom room(chunk, grid_.options.precision, grid_.options.normals != Normals::none,
                       max_bytes);
  const Threshold& threshold = grid_.classifier.threshold();
  const std::int32_t end =
      field::visit_type(threshold.type, [&]<class T>(field::TypeTag<T> /*tag*/) {
        return threshold.swap ? extract_typed<T, true>(slab, l0, l1, room, totals)
                              : extract_typed<T, false>(slab, l0, l1, room, totals);
      });
  totals.n_vertices = chunk.n_vertices();
  totals.n_triangles = chunk.n_triangles();
  return end;
}

void DenseExtractor::count(const Slab& slab, std::int32_t l0, std::int32_t l1,
                           SurfaceTotals& totals) {
  assert(0 <= l0 && l0 < l1 && l1 <= grid_.n_layers);
  totals.clear();
  shape_planes();
  load(slab, l0, shared_);
  totals.n_vertices = number_plane(view(l0), 0, bits(l0).ids());
  for (std::int32_t l = l0; l < l1; ++l) {
    load(slab, l + 1, l + 1 == l1 ? shared_ : nullptr);
    totals.n_vertices += number_between(view(l), view(l + 1), 0, k_start_.data());
    if (owns(l + 1, l1)) totals.n_vertices += number_plane(view(l + 1), 0, bits(l + 1).ids());
    totals.n_triangles += count_triangles(view(l), view(l + 1));
    totals.n_boundary_edges += grid_.border_sides(bits(l), bits(l + 1), l);
  }
}

std::uint64_t DenseExtractor::count_vertices(const Slab& slab, std::int32_t l0, std::int32_t l1,
                                             bool with_lowest) {
  assert(0 <= l0 && l0 < l1 && l1 <= grid_.n_layers);
  shape_planes();
  load(slab, l0, nullptr);
  std::uint64_t n = with_lowest ? number_plane(view(l0), 0, bits(l0).ids()) : 0;
  for (std::int32_t l = l0; l < l1; ++l) {
    load(slab, l + 1, nullptr);
    n += number_between(view(l), view(l + 1), 0, k_start_.data());
    if (owns(l + 1, l1)) n += number_plane(view(l + 1), 0, bits(l + 1).ids());
  }
  return n;
}

}  // namespace mc::extraction
