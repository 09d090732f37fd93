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

namespace {

/// Crossed edges of the faces between two neighbouring rows, an edge counted for each face it is
/// in: each face has none, two or four, and half as many sides of triangles.
std::uint64_t face_crossings(const std::uint64_t* a, const std::uint64_t* b, std::size_t n_samples,
                             std::size_t n_words) {
  const auto ones = [](std::uint64_t x) { return static_cast<std::uint64_t>(std::popcount(x)); };
  std::uint64_t n = 0;
  for (std::size_t w = 0; w < n_words; ++w) {
    const std::uint64_t mask = cell_mask(n_samples, w);
    const std::uint64_t a_next = next_samples(a, w, n_words);
    const std::uint64_t b_next = next_samples(b, w, n_words);
    n += ones((a[w] ^ a_next) & mask) + ones((b[w] ^ b_next) & mask) + ones((a[w] ^ b[w]) & mask) +
         ones((a_next ^ b_next) & mask);
  }
  return n;
}

}  // namespace

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
  for (Plane* plane : {&lower_, &upper_}) {
    plane->words.resize(n_words_ * n_rows_ + 1);
    std::fill(plane->words.begin(), plane->words.end(), 0);
    plane->i_start.resize(n_rows_);
    plane->j_start.resize(n_rows_);
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
  return 2 * lower_.words.size() * sizeof(std::uint64_t) + 5 * n_rows_ * sizeof(std::uint32_t) +
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

template <class R>
EdgeList DenseExtractor::empty_list(EdgeBatch<R>& batch) const {
  const std::size_t room = list_room(bits(lower_)) + EdgeBatch<R>::kEnough;
  batch.reserve(room, options_.normals == Normals::gradient);
  return {box_.lo[0] - pad(), batch.i.data(), room, 0};
}

/// Makes the vertices on the edges of plane p, in the order of their ids, and numbers them.
template <class Writer, class Sampler, class R>
std::uint32_t DenseExtractor::write_plane(Plane& plane, std::int32_t p, std::uint32_t next,
                                          const Sampler& sampler, EdgeBatch<R>& batch,
                                          Writer& writer) const {
  const std::int32_t j_first = box_.lo[1] - pad();
  const std::int32_t k = box_.lo[2] - pad() + p;
  const PlaneIds first_ids = ids(plane);
  EdgeList list = empty_list(batch);
  for (std::size_t j = 0; j < n_rows_;) {
    const std::uint32_t first_id = next;
    const std::size_t end = list_plane(bits(plane), j, next, first_ids, list);
    for (; j < end; ++j) {
      const std::size_t i_edges = first_ids.i[j] - first_id;
      const std::size_t j_edges = first_ids.j[j] - first_id;
      const std::size_t row_end = j + 1 < end ? first_ids.i[j + 1] - first_id : list.n;
      const std::int32_t row = j_first + static_cast<std::int32_t>(j);
      gather_run(sampler, batch, i_edges, j_edges, row, k, 0, writer.wants_gradients());
      gather_run(sampler, batch, j_edges, row_end, row, k, 1, writer.wants_gradients());
    }
    batch.n = list.n;
    writer.flush();
  }
  return next;
}

/// The same for the edges between planes p and p + 1.
template <class Writer, class Sampler, class R>
std::uint32_t DenseExtractor::write_between(std::int32_t p, std::uint32_t next,
                                            const Sampler& sampler, EdgeBatch<R>& batch,
                                            Writer& writer) {
  const std::int32_t j_first = box_.lo[1] - pad();
  const std::int32_t k = box_.lo[2] - pad() + p;
  EdgeList list = empty_list(batch);
  for (std::size_t j = 0; j < n_rows_;) {
    const std::uint32_t first_id = next;
    const std::size_t end =
        list_between(bits(lower_), bits(upper_), j, next, k_start_.data(), list);
    for (; j < end; ++j) {
      const std::size_t row_end = j + 1 < end ? k_start_[j + 1] - first_id : list.n;
      gather_run(sampler, batch, k_start_[j] - first_id, row_end,
                 j_first + static_cast<std::int32_t>(j), k, 2, writer.wants_gradients());
    }
    batch.n = list.n;
    writer.flush();
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

std::uint64_t DenseExtractor::boundary_edges(std::int32_t layer) const {
  if (capped_) {
    return 0;
  }
  std::uint64_t crossings = 0;
  const auto bit = [](const std::uint64_t* row, std::size_t i) {
    return static_cast<unsigned>((row[i / 64] >> (i % 64)) & 1U);
  };
  const BitPlane lower = bits(lower_);
  const BitPlane upper = bits(upper_);
  for (std::size_t j = 0; j + 1 < n_rows_; ++j) {
    for (const std::size_t i : {std::size_t{0}, row_samples_ - 1}) {
      const unsigned a = bit(lower.row(j), i);
      const unsigned b = bit(lower.row(j + 1), i);
      const unsigned c = bit(upper.row(j), i);
      const unsigned d = bit(upper.row(j + 1), i);
      crossings += (a ^ b) + (c ^ d) + (a ^ c) + (b ^ d);
    }
  }
  for (const std::size_t j : {std::size_t{0}, n_rows_ - 1}) {
    crossings += face_crossings(lower.row(j), upper.row(j), row_samples_, n_words_);
  }
  const auto add_plane = [&](const BitPlane& plane) {
    for (std::size_t j = 0; j + 1 < n_rows_; ++j) {
      crossings += face_crossings(plane.row(j), plane.row(j + 1), row_samples_, n_words_);
    }
  };
  if (layer == 0) {
    add_plane(lower);
  }
  if (layer + 1 == n_layers()) {
    add_plane(upper);
  }
  return crossings / 2;
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
  using Sampler = SlabSampler<T, Swap>;
  const Sampler sampler(slab, box_);
  const VertexRules<T> rules(options_, to_world_, threshold_);
  auto& batch = std::get<EdgeBatch<Real<T>>>(batches_);
  VertexWriter<T, Sampler> writer(rules, sampler, options_.precision, batch, chunk, totals.bounds);

  classify(slab, l0, lower_);
  std::uint32_t next = write_plane(lower_, l0, 0, sampler, batch, writer);
  for (std::int32_t l = l0; l < l1; ++l) {
    classify(slab, l + 1, upper_);
    next = write_between(l, next, sampler, batch, writer);
    next = l + 1 < l1 || l1 == n_layers() ? write_plane(upper_, l + 1, next, sampler, batch, writer)
                                          : number_plane(bits(upper_), next, ids(upper_));
    emit_layer(chunk);
    totals.n_boundary_edges += boundary_edges(l);
    if (options_.measure) {
      totals.layers.push_back(measure(l, EdgeVertices<T, Sampler>(rules, sampler)));
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
  classify(slab, l0, lower_);
  totals.n_vertices = number_plane(bits(lower_), 0, ids(lower_));
  for (std::int32_t l = l0; l < l1; ++l) {
    classify(slab, l + 1, upper_);
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
