// SPDX-License-Identifier: MIT
#include "extract/dense.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

#include "extract/classify.hpp"
#include "extract/slab_sampler.hpp"
#include "extract/vertex_writer.hpp"

namespace mc::extraction {

DenseExtractor::DenseExtractor(const Volume& volume, const Affine& to_world,
                               const ExtractOptions& options)
    : type_(volume.type),
      to_world_(to_world),
      options_(options),
      placement_(to_world, options),
      box_(options.region.value_or(volume.lattice.box)),
      apex_(middle_of(box_)),
      threshold_(volume.type, volume.endian, options.iso, options.inside),
      capped_(options.border != Border::open),
      above_outside_((options.border == Border::solid) == (options.inside == Inside::above)) {
  assert(volume.lattice.box.contains(box_));
  const std::int64_t both = capped_ ? 2 : 0;
  row_samples_ = static_cast<std::size_t>(box_.extent(0) + both);
  n_rows_ = static_cast<std::size_t>(box_.extent(1) + both);
  const std::int64_t n_planes = box_.extent(2) + both;
  if (n_planes > std::numeric_limits<std::int32_t>::max() || max_layers() < 1) {
    throw Error(ErrorKind::limit, volume.name,
                "a plane of " + std::to_string(row_samples_) + "x" + std::to_string(n_rows_) +
                    " samples could hold more vertices than 32-bit ids can name",
                "extract it in parts with --region");
  }
  n_planes_ = static_cast<std::int32_t>(n_planes);
  n_words_ = padded_words(row_samples_);
  for (std::size_t w = 0; w < n_words_; ++w) cells_.push_back(cell_mask(row_samples_, w));
  const std::size_t n_column_words = (n_rows_ + 63) / 64;
  for (Plane* plane : {&lower_, &upper_}) {
    plane->words.resize(n_words_ * n_rows_ + 1);
    std::fill(plane->words.begin(), plane->words.end(), 0);
    plane->i_start.resize(n_rows_);
    plane->j_start.resize(n_rows_);
    plane->first_column.resize(n_column_words + 1);
    plane->last_column.resize(n_column_words + 1);
  }
  for (std::size_t w = 0; w < n_column_words; ++w) {
    column_cells_.push_back(cell_mask(n_rows_, w));
  }
  k_start_.resize(n_rows_);
}

std::int32_t DenseExtractor::max_layers() const {
  // l layers name at most 3 l + 2 vertices a sample of a plane.
  const std::uint64_t per_plane = std::uint64_t{row_samples_} * n_rows_;
  const std::uint64_t planes = std::numeric_limits<std::uint32_t>::max() / per_plane;
  return static_cast<std::int32_t>(
      std::min<std::uint64_t>(planes < 2 ? 0 : (planes - 2) / 3, 1U << 20U));
}

std::pair<std::int32_t, std::int32_t> DenseExtractor::planes_for(std::int32_t l0,
                                                                 std::int32_t l1) const {
  const bool ring = options_.normals != Normals::none;
  const std::int32_t first = box_.lo[2] + l0 - pad() - (ring ? 1 : 0);
  const std::int32_t last = box_.lo[2] + l1 - pad() + (ring ? 1 : 0);
  return {std::clamp(first, box_.lo[2], box_.hi[2]), std::clamp(last, box_.lo[2], box_.hi[2]) + 1};
}

std::uint64_t DenseExtractor::scratch_bytes() const {
  const std::size_t edges = list_room(bits(lower_)) + EdgeBatch<double>::kEnough;
  // Two planes of its own and one that it shares.
  return 3 * lower_.words.size() * sizeof(std::uint64_t) + 5 * n_rows_ * sizeof(std::uint32_t) +
         edges * EdgeBatch<double>::kBytesAnEdge;
}

BitPlane DenseExtractor::bits(const Plane& plane) const {
  return {plane.words.data(), cells_.data(), n_words_, row_samples_, n_rows_};
}

PlaneIds DenseExtractor::ids(Plane& plane) { return {plane.i_start.data(), plane.j_start.data()}; }

CellLayer DenseExtractor::layer() {
  return {bits(lower_), bits(upper_), ids(lower_), ids(upper_), k_start_.data()};
}

/// Moves a row's bits up by one sample and puts the constant layer at both ends.
void DenseExtractor::pad_row(std::uint64_t* row) const {
  for (std::size_t w = (row_samples_ + 63) / 64; w-- > 0;) {
    row[w] = (row[w] << 1) | (w > 0 ? row[w - 1] >> 63 : 0);
  }
  if (above_outside_) {
    const std::size_t last = row_samples_ - 1;
    row[0] |= 1;
    row[last / 64] |= std::uint64_t{1} << (last % 64);
  }
}

void DenseExtractor::classify(const Slab& slab, std::int32_t plane, Plane& out) const {
  const std::int32_t k = box_.lo[2] + plane - pad();
  const std::uint64_t constant = above_outside_ ? ~std::uint64_t{0} : 0;
  const auto fill_row = [&](std::size_t j) {
    std::uint64_t* row = out.words.data() + j * n_words_;
    std::fill_n(row, row_samples_ / 64, constant);
    if (row_samples_ % 64 != 0) {
      row[row_samples_ / 64] = constant & ((std::uint64_t{1} << (row_samples_ % 64)) - 1);
    }
  };
  if (k < box_.lo[2] || k > box_.hi[2]) {
    for (std::size_t j = 0; j < n_rows_; ++j) {
      fill_row(j);
    }
    return;
  }
  const auto n_samples = static_cast<std::size_t>(box_.extent(0));
  const auto n_rows = static_cast<std::size_t>(box_.extent(1));
  const std::byte* first = slab.planes[static_cast<std::size_t>(k - slab.k0)] +
                           static_cast<std::size_t>(box_.lo[1]) * slab.row_stride_bytes +
                           static_cast<std::size_t>(box_.lo[0]) * sample_size(type_);
  std::uint64_t* words = out.words.data() + static_cast<std::size_t>(pad()) * n_words_;
  classify_rows(threshold_, {first, slab.row_stride_bytes, n_samples, n_rows}, words, n_words_);
  if (!capped_) {
    return;
  }
  for (std::size_t j = 0; j < n_rows; ++j) {
    std::uint64_t* row = words + j * n_words_;
    std::fill(row + (n_samples + 63) / 64, row + n_words_, 0);
    pad_row(row);
  }
  fill_row(0);
  fill_row(n_rows_ - 1);
}

/// Keeps the first and the last sample of each row as rows of bits.
void DenseExtractor::take_columns(Plane& plane) const {
  const std::size_t last = row_samples_ - 1;
  for (std::size_t w = 0; 64 * w < n_rows_; ++w) {
    std::uint64_t first_word = 0;
    std::uint64_t last_word = 0;
    const std::size_t end = std::min<std::size_t>(64, n_rows_ - 64 * w);
    for (std::size_t b = 0; b < end; ++b) {
      const std::uint64_t* row = plane.words.data() + (64 * w + b) * n_words_;
      first_word |= (row[0] & 1U) << b;
      last_word |= (row[last / 64] >> (last % 64) & 1U) << b;
    }
    plane.first_column[w] = first_word;
    plane.last_column[w] = last_word;
  }
}

/// Makes the bits of a plane. One that two slabs share may have been made for the other.
void DenseExtractor::load(const Slab& slab, std::int32_t plane, bool is_shared, Plane& out) {
  SharedPlanes* const shared = is_shared ? shared_ : nullptr;
  if (shared == nullptr || !shared->take(plane, out.words)) {
    classify(slab, plane, out);
    if (shared != nullptr) shared->offer(plane, out.words);
  }
  take_columns(out);
}

/// What making the vertices of one slab takes.
template <class T, bool Swap>
struct DenseExtractor::VertexPass {
  using R = Real<T>;
  using Sampler = SlabSampler<T, Swap>;

  VertexPass(DenseExtractor& e, const Slab& slab, MeshChunk& chunk, Bounds& bounds)
      : rules(e.options_, e.to_world_, e.threshold_),
        sampler(slab, e.box_),
        vertices(rules, sampler),
        batch(std::get<EdgeBatch<R>>(e.batches_)),
        writer(rules, sampler, e.options_.precision, batch, chunk, bounds),
        gatherer(slab, sampler, vertices, writer.wants_gradients()) {
    const std::size_t room = list_room(e.bits(e.lower_)) + EdgeBatch<R>::kEnough;
    batch.reserve(room, writer.wants_gradients());
    list.first = {e.box_.lo[0] - e.pad(), e.box_.lo[1] - e.pad(), 0};
    list.i = batch.i.data();
    list.j = batch.j.data();
    list.axis = batch.axis.data();
    list.room = room;
  }

  /// Makes the vertices of the edges that were listed, which start in plane k.
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

/// Makes the vertices on the edges of plane p, in the order of their ids, and numbers them.
template <class Pass>
std::uint32_t DenseExtractor::write_plane(Plane& plane, std::int32_t p, std::uint32_t next,
                                          Pass& pass) const {
  for (std::size_t j = 0; j < n_rows_;) {
    j = list_plane(bits(plane), j, next, ids(plane), pass.list);
    pass.make(box_.lo[2] - pad() + p);
  }
  return next;
}

/// The same for the edges between planes p and p + 1.
template <class Pass>
std::uint32_t DenseExtractor::write_between(std::int32_t p, std::uint32_t next, Pass& pass) {
  for (std::size_t j = 0; j < n_rows_;) {
    j = list_between(bits(lower_), bits(upper_), j, next, k_start_.data(), pass.list);
    pass.make(box_.lo[2] - pad() + p);
  }
  return next;
}

void DenseExtractor::emit_layer(MeshChunk& chunk) {
  // Room is made for a run of rows at a time: what is not used is given back at once.
  const std::size_t rows_at_once = std::max<std::size_t>(1, 16384 / row_samples_);
  const CellLayer cells = layer();
  for (std::size_t j = 0; j + 1 < n_rows_; j += rows_at_once) {
    const std::size_t end = std::min(n_rows_ - 1, j + rows_at_once);
    const std::size_t before = chunk.indices.size();
    const std::size_t room = (end - j) * row_samples_ * 3 * kMaxTriangles + kEmitSlack;
    if (chunk.indices.capacity() < before + room) {
      chunk.indices.reserve(std::max(before + room, 2 * chunk.indices.capacity()));
    }
    chunk.indices.resize(before + room);
    const std::size_t n =
        emit_triangles(cells, j, end, placement_.flip, chunk.indices.data() + before);
    chunk.indices.resize(before + n);
  }
}

/// Sides of triangles in the volume's faces that the layer touches.
std::uint64_t DenseExtractor::boundary_edges(std::int32_t layer) const {
  if (capped_) {
    return 0;
  }
  const BitPlane lower = bits(lower_);
  const BitPlane upper = bits(upper_);
  const std::size_t column_words = (n_rows_ + 63) / 64;
  const std::size_t row_words = (row_samples_ + 63) / 64;
  const auto add_plane = [&](const BitPlane& plane) {
    std::uint64_t n = 0;
    for (std::size_t j = 0; j + 1 < n_rows_; ++j) {
      n += count_face_sides(plane.row(j), plane.row(j + 1), cells_.data(), row_words);
    }
    return n;
  };
  std::uint64_t n = count_face_sides(lower_.first_column.data(), upper_.first_column.data(),
                                     column_cells_.data(), column_words) +
                    count_face_sides(lower_.last_column.data(), upper_.last_column.data(),
                                     column_cells_.data(), column_words);
  for (const std::size_t j : {std::size_t{0}, n_rows_ - 1}) {
    n += count_face_sides(lower.row(j), upper.row(j), cells_.data(), row_words);
  }
  if (layer == 0) {
    n += add_plane(lower);
  }
  if (layer + 1 == n_layers()) {
    n += add_plane(upper);
  }
  return n;
}

template <class Vertices>
LayerSum DenseExtractor::measure(std::int32_t p, const Vertices& vertices) const {
  LayerSum sum;
  for (std::size_t j = 0; j + 1 < n_rows_; ++j) {
    for (std::size_t w = 0; w < n_words_; ++w) {
      std::uint64_t any = 0;
      std::uint64_t all = ~std::uint64_t{0};
      for (const Plane* plane : {&lower_, &upper_}) {
        for (const std::size_t row : {j, j + 1}) {
          const std::uint64_t* words = plane->words.data() + row * n_words_;
          const std::uint64_t next = next_samples(words, w, n_words_);
          any |= words[w] | next;
          all &= words[w] & next;
        }
      }
      for_each_bit(any & ~all & cell_mask(row_samples_, w), [&](int bit) {
        const Index3 cell{box_.lo[0] - pad() + index_in_row(w, bit),
                          box_.lo[1] - pad() + static_cast<std::int32_t>(j),
                          box_.lo[2] - pad() + p};
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
  load(slab, l0, true, lower_);
  std::uint32_t next = write_plane(lower_, l0, 0, pass);
  for (std::int32_t l = l0; l < l1; ++l) {
    load(slab, l + 1, l + 1 == l1, upper_);
    next = write_between(l, next, pass);
    const bool owned = l + 1 < l1 || l1 == n_layers();
    next = owned ? write_plane(upper_, l + 1, next, pass)
                 : number_plane(bits(upper_), next, ids(upper_));
    emit_layer(chunk);
    totals.n_boundary_edges += boundary_edges(l);
    if (options_.measure) {
      totals.layers.push_back(measure(l, pass.vertices));
    }
    std::swap(lower_, upper_);
  }
  totals.n_vertices = chunk.n_vertices();
  totals.n_triangles = chunk.n_triangles();
}

void DenseExtractor::extract(const Slab& slab, std::int32_t l0, std::int32_t l1, MeshChunk& chunk,
                             TaskTotals& totals) {
  assert(0 <= l0 && l0 < l1 && l1 <= n_layers());
  chunk.clear();
  totals.clear();
  field::visit_type(type_, [&]<class T>(field::TypeTag<T> /*tag*/) {
    if (threshold_.swap) {
      extract_typed<T, true>(slab, l0, l1, chunk, totals);
    } else {
      extract_typed<T, false>(slab, l0, l1, chunk, totals);
    }
  });
}

void DenseExtractor::count(const Slab& slab, std::int32_t l0, std::int32_t l1, TaskTotals& totals) {
  totals.clear();
  load(slab, l0, true, lower_);
  totals.n_vertices = number_plane(bits(lower_), 0, ids(lower_));
  for (std::int32_t l = l0; l < l1; ++l) {
    load(slab, l + 1, l + 1 == l1, upper_);
    totals.n_vertices += number_between(bits(lower_), bits(upper_), 0, k_start_.data());
    if (l + 1 < l1 || l1 == n_layers()) {
      totals.n_vertices += number_plane(bits(upper_), 0, ids(upper_));
    }
    totals.n_triangles += count_triangles(bits(lower_), bits(upper_));
    totals.n_boundary_edges += boundary_edges(l);
    std::swap(lower_, upper_);
  }
}

}  // namespace mc::extraction
