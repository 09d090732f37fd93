// SPDX-License-Identifier: MIT
#include "extract/dense.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "extract/slab_sampler.hpp"

namespace mc::extraction {

DenseExtractor::DenseExtractor(const Volume& volume, const Affine& to_world,
                               const ExtractOptions& options)
    : DenseExtractor(volume, to_world, options, PlaneClassifier(volume, options).whole()) {}

DenseExtractor::DenseExtractor(const Volume& volume, const Affine& to_world,
                               const ExtractOptions& options, const IndexBox& part)
    : name_(volume.name),
      to_world_(to_world),
      options_(options),
      placement_(to_world, options),
      classifier_(volume, options),
      apex_(middle_of(options.region.value_or(volume.lattice.box))) {
  assert(volume.lattice.box.contains(options.region.value_or(volume.lattice.box)));
  set_part(part);
}

void DenseExtractor::set_part(const IndexBox& part) {
  classifier_.set_part(part);
  const std::size_t row_samples = classifier_.row_samples();
  const std::size_t n_rows = classifier_.n_rows();
  if (classifier_.n_planes() > std::numeric_limits<std::int32_t>::max() || max_layers() < 1) {
    throw Error(ErrorKind::limit, name_,
                "a plane of " + std::to_string(row_samples) + "x" + std::to_string(n_rows) +
                    " samples could hold more vertices than 32-bit ids can name",
                "extract it in parts with --region");
  }
  n_layers_ = static_cast<std::int32_t>(classifier_.n_planes()) - 1;
  for (PlaneBits& plane : planes_) classifier_.shape(plane);
  k_start_.resize(n_rows);
}

std::int32_t DenseExtractor::max_layers() const {
  // l layers name at most 3 l + 2 vertices a sample of a plane.
  const std::uint64_t per_plane = std::uint64_t{classifier_.row_samples()} * classifier_.n_rows();
  const std::uint64_t planes = std::numeric_limits<std::uint32_t>::max() / per_plane;
  return static_cast<std::int32_t>(
      std::min<std::uint64_t>(planes < 2 ? 0 : (planes - 2) / 3, 1U << 20U));
}

std::pair<std::int32_t, std::int32_t> DenseExtractor::planes_for(std::int32_t l0,
                                                                 std::int32_t l1) const {
  const IndexBox& box = samples();
  const std::int32_t ring = options_.normals != Normals::none ? 1 : 0;
  const std::int32_t first = classifier_.first_of(l0)[2] - ring;
  const std::int32_t last = classifier_.first_of(l1)[2] + ring;
  return {std::clamp(first, box.lo[2], box.hi[2]), std::clamp(last, box.lo[2], box.hi[2]) + 1};
}

std::uint64_t DenseExtractor::scratch_bytes() const {
  const std::size_t edges = list_room(classifier_.view(planes_[0])) + EdgeBatch<double>::kEnough;
  // Three planes of its own and two that it shares.
  return 5 * classifier_.plane_bytes() + 7 * classifier_.n_rows() * sizeof(std::uint32_t) +
         edges * EdgeBatch<double>::kBytesAnEdge;
}

/// Makes the bits of a plane. One that slabs share may have been made for another.
void DenseExtractor::load(const Slab& slab, std::int32_t plane, bool is_shared) {
  SharedPlanes* const shared = is_shared ? shared_ : nullptr;
  PlaneBits& out = bits(plane);
  if (shared == nullptr || !shared->take(plane, out.words)) {
    classifier_.classify(slab, plane, 0, classifier_.n_rows(), out);
    if (shared != nullptr) shared->offer(plane, out.words);
  }
  classifier_.take_columns(out);
}

std::uint64_t DenseExtractor::border_sides(std::int32_t layer) const {
  return classifier_.border_sides(bits(layer), bits(layer + 1), layer == 0, layer + 1 == n_layers_);
}

/// What making the vertices of one slab takes.
template <class T, bool Swap>
struct DenseExtractor::VertexPass {
  using R = Real<T>;
  using Sampler = SlabSampler<T, Swap>;

  VertexPass(DenseExtractor& e, const Slab& slab, MeshChunk& chunk, Bounds& bounds)
      : rules(e.options_, e.to_world_, e.classifier_.threshold()),
        sampler(slab, e.samples()),
        vertices(rules, sampler),
        batch(std::get<EdgeBatch<R>>(e.batches_)),
        writer(rules, sampler, e.options_.precision, batch, chunk, bounds),
        gatherer(slab, sampler, vertices, writer.wants_gradients()) {
    list.room = list_room(e.classifier_.view(e.planes_[0])) + EdgeBatch<R>::kEnough;
    batch.reserve(list.room, writer.wants_gradients());
    list.first = e.classifier_.first_of(0);
    list.i = batch.i.data();
    list.j = batch.j.data();
    list.axis = batch.axis.data();
  }

  /// Makes the vertices of the edges that were listed, which start in plane k of the lattice.
  void make(std::int32_t k) {
    batch.n = list.n;
    if (batch.n == 0) return;
    std::fill_n(batch.k.begin(), batch.n, k);
    gatherer.gather(batch, k, rules.capped);
    writer.flush();
  }

  VertexRules<T> rules;
  Sampler sampler;
  EdgeVertices<T, Sampler> vertices;
  EdgeBatch<R>& batch;
  VertexWriter<T, Sampler> writer;
  SlabGatherer<T, Swap> gatherer;
  EdgeList list;
};

/// Makes the vertices on the edges of a plane, in the order of their ids, and numbers them.
template <class Pass>
std::uint32_t DenseExtractor::write_plane(std::int32_t plane, std::uint32_t next, Pass& pass) {
  const std::size_t n_rows = classifier_.n_rows();
  for (std::size_t j = 0; j < n_rows;) {
    j = list_plane(classifier_.view(bits(plane)), j, n_rows, next, bits(plane).ids(), pass.list);
    pass.make(classifier_.first_of(plane)[2]);
  }
  return next;
}

/// The same for the edges between planes `layer` and layer + 1. On the way makes the bits of plane
/// `coming`, a band of rows before the vertices there are made: so its samples come from memory in
/// several streams, and are still in the cache when they are interpolated.
template <class Pass>
std::uint32_t DenseExtractor::write_between(std::int32_t layer, const Slab& slab,
                                            std::int32_t coming, std::uint32_t next, Pass& pass) {
  const std::size_t n_rows = classifier_.n_rows();
  const std::size_t band = classifier_.rows_at_once();
  for (std::size_t j = 0; j < n_rows;) {
    const std::size_t end = std::min(n_rows, j + band);
    if (coming != kNoPlane) classifier_.classify(slab, coming, j, end, bits(coming));
    while (j < end) {
      j = list_between(classifier_.view(bits(layer)), classifier_.view(bits(layer + 1)), j, end,
                       next, k_start_.data(), pass.list);
      pass.make(classifier_.first_of(layer)[2]);
    }
  }
  return next;
}

void DenseExtractor::emit_layer(std::int32_t layer, MeshChunk& chunk) {
  // Room is made for a run of rows at a time: what is not used is given back at once.
  const std::size_t row_samples = classifier_.row_samples();
  const std::size_t n_rows = classifier_.n_rows();
  const std::size_t rows_at_once = std::max<std::size_t>(1, 16384 / row_samples);
  const CellLayer cells{classifier_.view(bits(layer)), classifier_.view(bits(layer + 1)),
                        bits(layer).ids(), bits(layer + 1).ids(), k_start_.data()};
  for (std::size_t j = 0; j + 1 < n_rows; j += rows_at_once) {
    const std::size_t end = std::min(n_rows - 1, j + rows_at_once);
    const std::size_t before = chunk.indices.size();
    const std::size_t room = (end - j) * row_samples * 3 * kMaxTriangles + kEmitSlack;
    if (chunk.indices.capacity() < before + room) {
      chunk.indices.reserve(std::max(before + room, 2 * chunk.indices.capacity()));
    }
    chunk.indices.resize(before + room);
    const std::size_t n =
        emit_triangles(cells, j, end, placement_.flip, chunk.indices.data() + before);
    chunk.indices.resize(before + n);
  }
}

template <class Vertices>
LayerSum DenseExtractor::measure(std::int32_t layer, const Vertices& vertices) const {
  const BitPlane lower = classifier_.view(bits(layer));
  const BitPlane upper = classifier_.view(bits(layer + 1));
  const Index3 first = classifier_.first_of(layer);
  LayerSum sum;
  for (std::size_t j = 0; j + 1 < lower.n_rows; ++j) {
    for (std::size_t w = 0; w < lower.words_per_row; ++w) {
      std::uint64_t any = 0;
      std::uint64_t all = ~std::uint64_t{0};
      for (const std::uint64_t* row :
           {lower.row(j), lower.row(j + 1), upper.row(j), upper.row(j + 1)}) {
        const std::uint64_t next = next_samples(row, w, lower.words_per_row);
        any |= row[w] | next;
        all &= row[w] & next;
      }
      for_each_bit(any & ~all & lower.cells[w], [&](int bit) {
        const Index3 cell{first[0] + index_in_row(w, bit), first[1] + static_cast<std::int32_t>(j),
                          first[2]};
        add_cell(vertices, placement_, cell, kCases[vertices.case_of(cell)], apex_, sum);
      });
    }
  }
  return sum;
}

template <class T, bool Swap>
void DenseExtractor::extract_typed(const Slab& slab, std::int32_t l0, std::int32_t l1,
                                   MeshChunk& chunk, TaskTotals& totals) {
  VertexPass<T, Swap> pass(*this, slab, chunk, totals.bounds);
  for (std::int32_t plane = l0; plane <= l0 + reach(); ++plane) {
    load(slab, plane, true);
  }
  std::uint32_t next = write_plane(l0, 0, pass);
  for (std::int32_t l = l0; l < l1; ++l) {
    std::int32_t coming = l + 1 + reach();
    SharedPlanes* const shared = coming >= l1 ? shared_ : nullptr;
    if (coming >= n_planes() || (shared != nullptr && shared->take(coming, bits(coming).words))) {
      coming = kNoPlane;
    }
    next = write_between(l, slab, coming, next, pass);
    if (coming != kNoPlane && shared != nullptr) shared->offer(coming, bits(coming).words);
    classifier_.take_columns(bits(l + 1));
    const bool owned = l + 1 < l1 || l1 == n_layers_;
    next = owned ? write_plane(l + 1, next, pass)
                 : number_plane(classifier_.view(bits(l + 1)), next, bits(l + 1).ids());
    emit_layer(l, chunk);
    totals.n_boundary_edges += border_sides(l);
    if (options_.measure) {
      totals.layers.push_back(measure(l, pass.vertices));
    }
  }
  totals.n_vertices = chunk.n_vertices();
  totals.n_triangles = chunk.n_triangles();
}

void DenseExtractor::extract(const Slab& slab, std::int32_t l0, std::int32_t l1, MeshChunk& chunk,
                             TaskTotals& totals) {
  assert(0 <= l0 && l0 < l1 && l1 <= n_layers());
  chunk.clear();
  totals.clear();
  const Threshold& threshold = classifier_.threshold();
  field::visit_type(threshold.type, [&]<class T>(field::TypeTag<T> /*tag*/) {
    if (threshold.swap) {
      extract_typed<T, true>(slab, l0, l1, chunk, totals);
    } else {
      extract_typed<T, false>(slab, l0, l1, chunk, totals);
    }
  });
}

void DenseExtractor::count(const Slab& slab, std::int32_t l0, std::int32_t l1, TaskTotals& totals) {
  const auto view = [&](std::int32_t plane) { return classifier_.view(bits(plane)); };
  totals.clear();
  load(slab, l0, true);
  totals.n_vertices = number_plane(view(l0), 0, bits(l0).ids());
  for (std::int32_t l = l0; l < l1; ++l) {
    load(slab, l + 1, l + 1 == l1);
    totals.n_vertices += number_between(view(l), view(l + 1), 0, k_start_.data());
    if (l + 1 < l1 || l1 == n_layers_) {
      totals.n_vertices += number_plane(view(l + 1), 0, bits(l + 1).ids());
    }
    totals.n_triangles += count_triangles(view(l), view(l + 1));
    totals.n_boundary_edges += border_sides(l);
  }
}

}  // namespace mc::extraction
