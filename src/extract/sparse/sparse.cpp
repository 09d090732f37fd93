// SPDX-License-Identifier: MIT
#include "extract/sparse/sparse.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "extract/bits/bit_row.hpp"
#include "extract/sparse/block_masks.hpp"
#include "extract/sparse/block_sampler.hpp"

namespace mc::extraction {

namespace {

/// Ids of a block's triangles, five a cell.
constexpr std::size_t kBlockIndices = 3 * kMaxTriangles * LeafReader::kLeafSamples;

constexpr std::size_t kRingBytes = BlockSampler<double>::kScratchBytes;

/// Whether a box holds all samples that the vertices of a block can be made of.
bool holds_ring(const IndexBox& box, const Index3& block) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (block[a] * 8 - 1 < box.lo[a] || block[a] * 8 + 9 > box.hi[a]) return false;
  }
  return true;
}

bool any(const Mask512& mask) {
  return std::ranges::any_of(mask, [](std::uint64_t word) { return word != 0; });
}

}  // namespace

SparseExtractor::SparseExtractor(const SparsePlan& plan, const Affine& to_world)
    : plan_(plan),
      to_world_(to_world),
      placement_(to_world, plan.options()),
      apex_(middle_of(plan.options().region.value_or(plan.reader().volume().lattice.box))),
      queue_(plan.reader()) {}

std::uint64_t SparseExtractor::scratch_bytes() {
  return sizeof(SparseExtractor) + kKnown * sizeof(KnownEdges) + kRingBytes +
         LeafQueue::kScratchBytes + EdgeBatch<double>::kEnough * EdgeBatch<double>::kBytesAnEdge;
}

std::uint64_t SparseExtractor::most_bytes_of(std::size_t n_blocks, const ExtractOptions& options) {
  const std::uint64_t vertex =
      mesh::vertex_bytes(options.precision, options.normals != Normals::none);
  return (n_blocks * kBlockEdges + EdgeBatch<double>::kEnough + kEdgesAtOnce) * vertex +
         (n_blocks * kBlockIndices + kBlockSlack) * sizeof(std::uint32_t);
}

const SparseExtractor::KnownEdges& SparseExtractor::edges_at(const Walk& walk, std::size_t x,
                                                             std::size_t y, std::size_t z) {
  const std::size_t n = walk.at(x, y, z);
  KnownEdges& slot = known_[n % kKnown];
  if (slot.block != n) {
    slot.edges = find_edges(plan_.bits_around(walk, x, y, z),
                            plan_.samples_around(plan_.blocks()[n].at, samples_));
    slot.first = plan_.first_vertex(n);
    slot.block = n;
  }
  return slot;
}

void SparseExtractor::emit_triangles(const Walk& walk, std::uint64_t base, const BlockBits& above,
                                     const Mask512& cells, MeshChunk& chunk) {
  const KnownEdges& own = edges_at(walk, 0, 0, 0);
  const auto first_own = static_cast<std::uint32_t>(own.first - base);
  for (std::size_t e = 0; e < n_edges_; ++e) {
    ids_.ids[kEdgePlaces[edges_[e]].id] = first_own + static_cast<std::uint32_t>(e);
  }
  for (std::size_t d = 1; d < 7; ++d) {  // none of the cells' edges starts in block 7
    const std::size_t x = d & 1U;
    const std::size_t y = d >> 1 & 1U;
    const std::size_t z = d >> 2;
    if (walk.at(x, y, z) == kNoBlock) continue;
    const KnownEdges& there = edges_at(walk, x, y, z);
    const std::uint64_t first = there.first - base;
    if (first > std::numeric_limits<std::uint32_t>::max() - there.edges.n_vertices) {
      throw Error(ErrorKind::limit, plan_.reader().volume().name,
                  "a layer of blocks has more than 2^32-1 vertices", Remedy::smaller_region);
    }
    enter_ids(d, there.edges, static_cast<std::uint32_t>(first), ids_);
  }
  assert(n_edges_ == own.edges.n_vertices);
  const std::size_t before = chunk.indices.size();
  chunk.indices.resize(before + kBlockIndices + kBlockSlack);
  const std::size_t written =
      emit_block(above, cells, ids_, placement_.flip, chunk.indices.data() + before);
  chunk.indices.resize(before + written);
}

/// Sides of triangles in the faces of an open region: half the crossed edges of each cell's outer
/// faces.
std::uint64_t SparseExtractor::boundary_edges(const Index3& block, const BlockBits& above,
                                              const Mask512& cells) const {
  const IndexBox& box = plan_.box();
  const Index3 o = origin_of(block);
  bool at_border = false;
  for (std::size_t a = 0; a < 3; ++a) {
    at_border = at_border || o[a] <= box.lo[a] || o[a] + field::kBlockSize >= box.hi[a];
  }
  if (!at_border) return 0;
  const auto bit = [&](const Index3& p) {
    const std::int32_t n = (p[0] >> 3) + 2 * (p[1] >> 3) + 4 * (p[2] >> 3);
    return std::uint64_t{test(*above[static_cast<std::size_t>(n)], bit_index(p))};
  };
  std::uint64_t crossings = 0;
  for (std::int32_t k = 0; k < 8; ++k) {
    for_each_bit(cells[static_cast<std::size_t>(k)], [&](int at) {
      const Index3 cell{at & 7, at >> 3, k};
      for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t u = (a + 1) % 3;
        const std::size_t v = (a + 2) % 3;
        for (const std::int32_t side : {0, 1}) {
          const std::int32_t border = side == 0 ? box.lo[a] : box.hi[a];
          if (o[a] + cell[a] + side != border) continue;
          std::array<std::uint64_t, 4> corner;
          for (std::int32_t c = 0; c < 4; ++c) {
            Index3 p = cell;
            p[a] += side;
            p[u] += c & 1;
            p[v] += c >> 1;
            corner[static_cast<std::size_t>(c)] = bit(p);
          }
          crossings += (corner[0] ^ corner[1]) + (corner[2] ^ corner[3]) + (corner[0] ^ corner[2]) +
                       (corner[1] ^ corner[3]);
        }
      }
    });
  }
  return crossings / 2;
}

/// The vertices of a block in the dense order: plane by plane, row by row, i before j; then k.
template <class Sampler, class Writer>
void SparseExtractor::write_vertices(const Index3& block, bool at_border, Sampler& sampler,
                                     Writer& writer) {
  const Index3 o = origin_of(block);
  const auto edge_of = [&](std::uint16_t edge) {
    const EdgePlace& p = kEdgePlaces[edge];
    return LatticeEdge{{o[0] + p.i, o[1] + p.j, o[2] + p.k}, Axis(p.axis)};
  };
  if (at_border) {
    for (std::size_t e = 0; e < n_edges_; ++e) writer.write(edge_of(edges_[e]));
    return;
  }
  std::array<const std::byte*, 4> sources{};
  std::uint32_t wanted = 1;
  for (std::size_t e = 0; e < n_edges_; ++e) wanted |= 1U << kEdgePlaces[edges_[e]].upper_source;
  for (std::size_t s = 0; s < 4; ++s) {
    if ((wanted >> s & 1U) != 0) sources[s] = sampler.source(s);
  }
  if (writer.wants_gradients()) {
    writer.write_inside(n_edges_, [&](std::size_t e) {
      const EdgePlace& p = kEdgePlaces[edges_[e]];
      return typename Writer::CutEdge{
          edge_of(edges_[e]), sampler.real(sources[0], p.lower),
          sampler.real(sources[p.upper_source], p.upper), sampler.gradient(p.i, p.j, p.k),
          sampler.gradient(p.i + (p.axis == 0), p.j + (p.axis == 1), p.k + (p.axis == 2))};
    });
    return;
  }
  writer.write_inside(n_edges_, [&](std::size_t e) {
    const EdgePlace& p = kEdgePlaces[edges_[e]];
    return typename Writer::CutEdge{edge_of(edges_[e]),
                                    sampler.real(sources[0], p.lower),
                                    sampler.real(sources[p.upper_source], p.upper),
                                    {},
                                    {}};
  });
}

template <class T>
std::size_t SparseExtractor::extract_typed(std::size_t first, std::size_t last,
                                           mesh::ChunkRoom& room, SurfaceTotals& totals) {
  using Sampler = BlockSampler<T>;
  const ExtractOptions& options = plan_.options();
  Sampler sampler(plan_.reader(), plan_.index(), plan_.box(), ring_scratch_.data());
  VertexRules<T> rules(options, to_world_, plan_.threshold());
  rules.capped = plan_.capped();
  const EdgeVertices<T, Sampler> vertices(rules, sampler);
  VertexWriter<T, Sampler> writer(rules, sampler, options.precision,
                                  std::get<EdgeBatch<Real<T>>>(batches_), room.chunk(),
                                  totals.bounds);
  const std::uint64_t base = plan_.first_vertex(first);
  Walk walk(plan_.blocks());
  BlockSamples samples;
  LeafWalk leaves(plan_.reader().leaves(), plan_.blocks()[first].at);
  std::size_t ahead = first;
  const auto push = [&] {
    queue_.push(ahead < last ? leaves.find(plan_.blocks()[ahead].at) : Block::kConstant);
    ++ahead;
  };
  queue_.clear();
  for (std::size_t n = 0; n < LeafQueue::kAhead; ++n) push();
  std::size_t n = first;
  for (; n < last; ++n) {
    const Index3& block = plan_.blocks()[n].at;
    // Vertices wait for a whole batch; a batch ends with a vector's width more.
    if (!room.make_for_vertices(writer.n_waiting() + plan_.blocks()[n].n_vertices + kEdgesAtOnce) ||
        !room.make_for_indices(kBlockIndices + kBlockSlack)) {
      break;
    }
    walk.move_to(n);
    sampler.move_to(block, queue_.pop());
    n_edges_ = list_edges(edges_at(walk, 0, 0, 0).edges, edges_.data());
    const BlockBits* exists = plan_.samples_around(block, samples);
    write_vertices(block, !holds_ring(plan_.box(), block), sampler, writer);
    if (options.normals != Normals::none) writer.flush();  // while the sampler is here
    const BlockBits above = plan_.bits_around(walk, 0, 0, 0);
    const Mask512 cells = find_cells(above, exists);
    emit_triangles(walk, base, above, cells, room.chunk());
    if (options.region && !plan_.capped()) {
      totals.n_boundary_edges += boundary_edges(block, above, cells);
    }
    if (options.measure && any(cells)) {
      const Index3 o = origin_of(block);
      LayerSum sum;
      for (std::int32_t k = 0; k < 8; ++k) {
        for_each_bit(cells[static_cast<std::size_t>(k)], [&](int at) {
          const Index3 within{at & 7, at >> 3, k};
          const Index3 cell{o[0] + within[0], o[1] + within[1], o[2] + within[2]};
          add_cell(vertices, placement_, cell, kCases[case_in(above, within)], apex_, sum);
        });
      }
      totals.layers.push_back(sum);
    }
    push();
  }
  writer.flush();
  return n;
}

std::size_t SparseExtractor::extract(std::size_t first, std::size_t last, std::uint64_t max_bytes,
                                     MeshChunk& chunk, SurfaceTotals& totals) {
  assert(first < last && last <= plan_.n_own());
  chunk.clear();
  totals.clear();
  known_.resize(kKnown);
  ring_scratch_.resize(kRingBytes);
  const ExtractOptions& options = plan_.options();
  mesh::ChunkRoom room(chunk, options.precision, options.normals != Normals::none, max_bytes);
  const std::size_t end =
      field::visit_type(plan_.threshold().type, [&]<class T>(field::TypeTag<T> /*tag*/) {
        return extract_typed<T>(first, last, room, totals);
      });
  totals.n_vertices = chunk.n_vertices();
  totals.n_triangles = chunk.n_triangles();
  return end;
}

void SparseExtractor::count(std::size_t first, std::size_t last, SurfaceTotals& totals) {
  assert(first <= last && last <= plan_.n_own());
  totals.clear();
  totals.n_vertices = plan_.first_vertex(last) - plan_.first_vertex(first);
  BlockWalk<2> walk(plan_.blocks());
  BlockSamples samples;
  for (std::size_t n = first; n < last; ++n) {
    walk.move_to(n);
    const BlockBits above = plan_.bits_around(walk, 0, 0, 0);
    const BlockBits* exists = plan_.samples_around(plan_.blocks()[n].at, samples);
    const Mask512 cells = find_cells(above, exists);
    totals.n_triangles += count_block_triangles(above, cells);
    if (plan_.options().region && !plan_.capped()) {
      totals.n_boundary_edges += boundary_edges(plan_.blocks()[n].at, above, cells);
    }
  }
}

}  // namespace mc::extraction
