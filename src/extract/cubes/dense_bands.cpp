// SPDX-License-Identifier: MIT
#include "extract/cubes/dense_bands.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "base/parallel.hpp"
#include "extract/cubes/triangle_kernels.hpp"

namespace mc::extraction {

namespace {

/// A cell with e crossed edges has at most 5/7 e triangles: loops of n edges have n - 2 each, and
/// none is longer than seven.
constexpr std::uint64_t indices_within(std::uint64_t crossings) { return crossings * 15 / 7; }

/// Of a row in a plane.
std::uint64_t i_crossings(const PlaneBits& plane, std::size_t j) {
  return plane.j_start[j] - plane.i_start[j];
}
std::uint64_t j_crossings(const PlaneBits& plane, std::size_t j) {
  return j + 1 < plane.i_start.size() ? plane.i_start[j + 1] - plane.j_start[j] : 0;
}

void move_ids(PlaneBits& plane, std::uint32_t down) {
  for (std::uint32_t& id : plane.i_start) id -= down;
  for (std::uint32_t& id : plane.j_start) id -= down;
}

/// Rows that one thread classifies at a time.
constexpr std::size_t kRowsApiece = 64;

}  // namespace

DenseBands::DenseBands(DenseGrid grid, std::size_t n_makers)
    : grid_(std::move(grid)), makers_(n_makers) {
  for (PlaneBits& plane : planes_) grid_.classifier.shape(plane);
  k_start_.resize(grid_.classifier.n_rows() + 1);
}

/// A third of the bytes for vertices, the others for triangles: white noise has them so.
DenseBands::Most DenseBands::most_of(const DenseGrid& grid, std::uint64_t bytes) {
  const ExtractOptions& o = grid.options;
  const std::uint64_t vertices =
      bytes / 3 / mesh::vertex_bytes(o.precision, o.normals != Normals::none);
  const std::uint64_t indices = (bytes - bytes / 3) / sizeof(std::uint32_t);
  return {vertices - std::min<std::uint64_t>(vertices, kEdgesAtOnce),
          indices - std::min<std::uint64_t>(indices, kEmitSlack)};
}

std::uint64_t DenseBands::least_bytes(const DenseGrid& grid) {
  const ExtractOptions& o = grid.options;
  const std::uint64_t n = grid.classifier.row_samples();
  const std::uint64_t vertices =
      (2 * n + kEdgesAtOnce) * mesh::vertex_bytes(o.precision, o.normals != Normals::none);
  const std::uint64_t indices = (indices_within(12 * n) + kEmitSlack) * sizeof(std::uint32_t);
  return std::max(3 * vertices, (3 * indices + 1) / 2) + 64;
}

std::uint64_t DenseBands::scratch_bytes(const DenseGrid& grid, std::size_t n_makers) {
  const std::uint64_t ids = grid.classifier.n_rows() * sizeof(std::uint32_t);
  return 2 * grid.classifier.plane_bytes() + 5 * ids +
         n_makers * (edge_batch_bytes(grid) + 2 * ids);
}

void DenseBands::load(std::int32_t plane) {
  PlaneBits& out = bits(plane);
  base::for_ranges(grid_.classifier.n_rows(), kRowsApiece, [&](std::size_t j0, std::size_t j1) {
    grid_.classifier.classify(*slab_, plane, j0, j1, out);
  });
  grid_.select(plane, out);
  grid_.classifier.take_columns(out);
}

void DenseBands::start(const Slab& slab, std::int32_t l0, std::int32_t l1, bool with_lowest,
                       std::uint64_t max_bytes) {
  assert(0 <= l0 && l0 < l1 && l1 <= grid_.n_layers);
  assert(max_bytes >= least_bytes(grid_));
  slab_ = &slab;
  layer_ = l0;
  l1_ = l1;
  begun_ = false;
  with_lowest_ = with_lowest;
  most_ = most_of(grid_, max_bytes);
  n_before_ = 0;
  load(l0);
  n_lower_ = number_plane(view(l0), 0, bits(l0).ids());
}

/// The upper plane becomes the lower.
void DenseBands::end_layer() {
  n_before_ += (with_lowest_ ? n_lower_ : 0) + n_between_ + n_upper_;
  with_lowest_ = false;
  ++layer_;
  move_ids(bits(layer_), n_lower_ + n_between_);
  n_lower_ = n_upper_;
}

/// Crossed edges of the cells of a row, counted once a cell.
std::uint64_t DenseBands::row_crossings(std::size_t j) const {
  const PlaneBits& lower = bits(layer_);
  const PlaneBits& upper = bits(layer_ + 1);
  if (j + 1 == grid_.classifier.n_rows()) return 0;
  const std::uint64_t along = i_crossings(lower, j) + i_crossings(lower, j + 1) +
                              i_crossings(upper, j) + i_crossings(upper, j + 1);
  const std::uint64_t across =
      j_crossings(lower, j) + j_crossings(upper, j) + (k_start_[j + 2] - k_start_[j]);
  return along + 2 * across;
}

/// Cuts rows into bands that hold no more than they may.
template <class Vertices, class Crossings>
void DenseBands::cut(Band::Of of, const Vertices& vertices_in, const Crossings& crossings_in) {
  Band band{of, 0, 0};
  std::uint64_t n_vertices = 0, crossings = 0;
  for (; band.last < grid_.classifier.n_rows(); ++band.last) {
    const std::uint64_t more_vertices = vertices_in(band.last);
    const std::uint64_t more_crossings = crossings_in(band.last);
    if (n_vertices + more_vertices > most_.vertices ||
        indices_within(crossings + more_crossings) > most_.indices) {
      if (band.first < band.last) bands_.push_back(band);
      band.first = band.last;
      n_vertices = crossings = 0;
    }
    n_vertices += more_vertices;
    crossings += more_crossings;
  }
  bands_.push_back(band);
}

void DenseBands::cut_plane(Band::Of of, std::int32_t plane) {
  const PlaneBits& p = bits(plane);
  cut(
      of, [&](std::size_t j) { return i_crossings(p, j) + j_crossings(p, j); },
      [](std::size_t) { return std::uint64_t{0}; });
}

std::size_t DenseBands::next() {
  if (begun_) end_layer();
  begun_ = true;
  bands_.clear();
  if (layer_ == l1_) return 0;
  const bool with_upper = layer_ + 1 < l1_ || l1_ == grid_.n_layers;
  load(layer_ + 1);
  const std::uint32_t first_upper =
      number_between(view(layer_), view(layer_ + 1), n_lower_, k_start_.data());
  k_start_.back() = first_upper;
  n_between_ = first_upper - n_lower_;
  n_upper_ = number_plane(view(layer_ + 1), first_upper, bits(layer_ + 1).ids()) - first_upper;
  if (with_lowest_) cut_plane(Band::Of::lower, layer_);
  cut(
      Band::Of::between, [&](std::size_t j) { return k_start_[j + 1] - k_start_[j]; },
      [&](std::size_t j) { return row_crossings(j); });
  if (with_upper) cut_plane(Band::Of::upper, layer_ + 1);
  return bands_.size();
}

void DenseBands::emit(const Band& band, mesh::ChunkRoom& room) const {
  const CellLayer cells{view(layer_), view(layer_ + 1), bits(layer_).row_ids(),
                        bits(layer_ + 1).row_ids(), k_start_.data()};
  const std::size_t end = std::min(band.last, grid_.classifier.n_rows() - 1);
  std::uint64_t crossings = 0;
  for (std::size_t j = band.first; j < end; ++j) crossings += row_crossings(j);
  Buffer<std::uint32_t>& indices = room.chunk().indices;
  indices.resize(indices_within(crossings) + kEmitSlack);
  assert(band.first <= end);
  indices.resize(emit_triangles(cells, band.first, end, grid_.placement.flip, indices.data()));
}

template <class T, bool Swap>
void DenseBands::make_typed(const Band& band, bool is_first, Maker& maker, mesh::ChunkRoom& room,
                            SurfaceTotals& totals) const {
  VertexPass<T, Swap> pass(grid_, *slab_, maker.batches, room, totals.bounds);
  const PlaneIds ids{maker.i_ids.data(), maker.j_ids.data()};
  if (band.of == Band::Of::between) {
    write_between(view(layer_), view(layer_ + 1), grid_.classifier.first_of(layer_)[2], band.first,
                  band.last, 0, ids.i, pass);
    emit(band, room);
  } else {
    const std::int32_t plane = layer_ + (band.of == Band::Of::upper ? 1 : 0);
    write_plane(view(plane), grid_.classifier.first_of(plane)[2], band.first, band.last, 0, ids,
                pass);
  }
  pass.flush();
  if (!is_first) return;
  totals.n_boundary_edges = grid_.border_sides(bits(layer_), bits(layer_ + 1), layer_);
  if (grid_.options.measure) {
    totals.layers.push_back(grid_.measure(view(layer_), view(layer_ + 1), layer_, pass.vertices()));
  }
}

void DenseBands::make(std::size_t n, std::size_t with, MeshChunk& chunk, SurfaceTotals& totals) {
  assert(n < bands_.size() && with < makers_.size());
  Maker& maker = makers_[with];
  chunk.clear();
  totals.clear();
  maker.i_ids.resize(grid_.classifier.n_rows());
  maker.j_ids.resize(grid_.classifier.n_rows());
  mesh::ChunkRoom room(chunk, grid_.options.precision, grid_.options.normals != Normals::none,
                       mesh::ChunkRoom::kUnlimited);
  room.make_for_vertices(most_.vertices + kEdgesAtOnce);  // once: bands differ, memory stays
  chunk.indices.reserve(most_.indices + kEmitSlack);
  const Threshold& threshold = grid_.classifier.threshold();
  field::visit_type(threshold.type, [&]<class T>(field::TypeTag<T> /*tag*/) {
    if (threshold.swap) {
      make_typed<T, true>(bands_[n], n == 0, maker, room, totals);
    } else {
      make_typed<T, false>(bands_[n], n == 0, maker, room, totals);
    }
  });
  // The layer's ids count from its lower plane's first vertex.
  chunk.index_base = n_before_ - (with_lowest_ ? 0 : n_lower_);
  totals.n_vertices = chunk.n_vertices();
  totals.n_triangles = chunk.n_triangles();
}

}  // namespace mc::extraction
