// SPDX-License-Identifier: MIT
#include "extract/sparse.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "base/parallel.hpp"
#include "extract/bit_row.hpp"
#include "extract/classify.hpp"
#include "extract/vertex_writer.hpp"

namespace mc::extraction {

namespace {

constexpr std::size_t kLeafBytes = LeafReader::kLeafSamples * sizeof(double);
/// Indices that leave room for neighbours in 32 bits.
constexpr std::int32_t kReach = (1 << 30) - 1;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

Index3 neighbour(const Index3& block, std::size_t n) {
  return {block[0] + static_cast<std::int32_t>(n & 1U),
          block[1] + static_cast<std::int32_t>(n >> 1U & 1U),
          block[2] + static_cast<std::int32_t>(n >> 2U)};
}

Index3 origin_of(const Index3& block) { return {block[0] * 8, block[1] * 8, block[2] * 8}; }

/// Samples of a block and the ring of blocks around it, addressed by lattice index.
template <class T>
class BlockSampler {
 public:
  BlockSampler(const LeafReader& reader, const BlockIndex& index, const IndexBox& box,
               std::byte* scratch)
      : reader_(reader), index_(index), box_(box), scratch_(scratch) {}

  void move_to(const Index3& block) {
    corner_ = {block[0] - 1, block[1] - 1, block[2] - 1};
    known_ = 0;
  }
  [[nodiscard]] const IndexBox& box() const noexcept { return box_; }
  [[nodiscard]] T raw(const Index3& p) const {
    const Index3 block = block_of(p);
    const auto n = static_cast<std::size_t>((block[0] - corner_[0]) + 3 * (block[1] - corner_[1]) +
                                            9 * (block[2] - corner_[2]));
    assert(n < 27);
    if ((known_ >> n & 1U) == 0) {
      look_up(block, n);
    }
    if (values_[n] == nullptr) {
      return constants_[n];
    }
    const auto at = static_cast<std::size_t>((p[0] & 7) * 64 + (p[1] & 7) * 8 + (p[2] & 7));
    return field::load_sample<T, false>(values_[n] + at * sizeof(T));
  }
  [[nodiscard]] Real<T> at(const Index3& p) const {
    return static_cast<Real<T>>(field::number(raw(p)));
  }

 private:
  void look_up(const Index3& block, std::size_t n) const {
    const Block found = index_.at(block);
    values_[n] = nullptr;
    if (found.leaf == Block::kConstant) {
      constants_[n] = found.value.as<T>();
    } else {
      values_[n] = reader_.leaf_values(found.leaf, scratch_ + n * kLeafBytes);
    }
    known_ |= 1U << n;
  }

  const LeafReader& reader_;
  const BlockIndex& index_;
  IndexBox box_;
  std::byte* scratch_;
  Index3 corner_{};
  // Filled as they are asked for.
  mutable std::uint32_t known_ = 0;
  mutable std::array<const std::byte*, 27> values_{};
  mutable std::array<T, 27> constants_{};
};

}  // namespace

SparsePlan::SparsePlan(const LeafReader& reader, const Affine& to_world,
                       const ExtractOptions& options)
    : reader_(reader),
      to_world_(to_world),
      options_(options),
      placement_(to_world, options),
      threshold_(reader.volume().type, std::endian::native, options.iso, options.inside),
      index_(reader, threshold_),
      box_(
          options.region.value_or(IndexBox{{-kReach, -kReach, -kReach}, {kReach, kReach, kReach}})),
      capped_(options.border != Border::open),
      above_outside_((options.border == Border::solid) == (options.inside == Inside::above)),
      apex_(middle_of(options.region.value_or(reader.volume().lattice.box))) {
  classify_leaves();
  find_blocks();
  count_blocks();
}

std::uint64_t SparsePlan::bytes() const {
  return index_.bytes() + leaf_bits_.capacity() * sizeof(Mask512) +
         blocks_.capacity() * sizeof(Index3) + first_.capacity() * sizeof(std::uint64_t) +
         n_triangles_.capacity() * sizeof(std::uint16_t);
}

void SparsePlan::classify_leaves() {
  const std::size_t sample_bytes = sample_size(threshold_.type);
  leaf_bits_.resize(reader_.leaves().size());
  base::for_ranges(leaf_bits_.size(), 256, [&](std::size_t begin, std::size_t end) {
    std::vector<std::byte> scratch(kLeafBytes);
    for (std::size_t n = begin; n < end; ++n) {
      const std::byte* values = reader_.leaf_values(n, scratch.data());
      Mask512 slices;
      classify_rows(threshold_,
                    {values, LeafReader::kLeafSamples * sample_bytes, LeafReader::kLeafSamples, 1},
                    slices.data(), slices.size());
      leaf_bits_[n] = planes_of(slices);
    }
  });
}

void SparsePlan::find_blocks() {
  blocks_ = index_.candidates();
  const std::int32_t margin = capped_ ? 1 : 0;
  const auto touches = [&](const Index3& block) {
    const Index3 o = origin_of(block);
    for (std::size_t a = 0; a < 3; ++a) {
      if (o[a] + 7 < box_.lo[a] - margin || o[a] > box_.hi[a] + margin) return false;
    }
    return true;
  };
  const auto reaches = [](std::int32_t x) { return x <= -kReach || x >= kReach; };
  bool too_far = options_.region &&
                 (std::ranges::any_of(box_.lo, reaches) || std::ranges::any_of(box_.hi, reaches));
  for (const Index3& block : blocks_) {
    too_far = too_far || std::ranges::any_of(origin_of(block), reaches);
  }
  if (too_far) {
    throw Error(ErrorKind::limit, reader_.volume().name,
                "the grid or region reaches past index +-2^30, beyond what can be extracted");
  }
  if (!options_.region) return;
  blocks_.erase(
      std::remove_if(blocks_.begin(), blocks_.end(), [&](const Index3& b) { return !touches(b); }),
      blocks_.end());
  if (capped_) add_region_faces();
}

/// With a closed border, constant blocks at the region's faces hold a surface too.
void SparsePlan::add_region_faces() {
  Index3 lo = block_of(step(step(step(box_.lo, 0, -1), 1, -1), 2, -1));
  Index3 hi = block_of(step(step(step(box_.hi, 0), 1), 2));
  // The blocks of the outer layer, and of the samples next to it.
  const Index3 lo_in = block_of(box_.lo);
  const Index3 hi_in = block_of(box_.hi);
  if (index_.background_above() == above_outside_) {
    // Where nothing is stored the border parts like from like.
    const IndexBox stored = index_.stored_blocks();
    for (std::size_t a = 0; a < 3; ++a) {
      lo[a] = std::max(lo[a], stored.lo[a] - 1);
      hi[a] = std::min(hi[a], stored.hi[a]);
    }
  }
  for (std::int32_t z = lo[2]; z <= hi[2]; ++z) {
    for (std::int32_t y = lo[1]; y <= hi[1]; ++y) {
      const bool face = z <= lo_in[2] || z >= hi_in[2] || y <= lo_in[1] || y >= hi_in[1];
      for (std::int32_t x = lo[0]; x <= hi[0]; ++x) {
        if (!face && x > lo_in[0] && x < hi_in[0]) {
          x = hi_in[0] - 1;
          continue;
        }
        blocks_.push_back({x, y, z});
      }
    }
  }
  std::sort(blocks_.begin(), blocks_.end(), before);
  blocks_.erase(std::unique(blocks_.begin(), blocks_.end()), blocks_.end());
}

/// Ones for the samples of a block that lie in the region, or at most `margin` outside.
Mask512 SparsePlan::inside_region(const Index3& block, std::int32_t margin) const {
  const Index3 o = origin_of(block);
  std::array<std::uint32_t, 3> within{};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::int32_t n = 0; n < 8; ++n) {
      const bool in = o[a] + n >= box_.lo[a] - margin && o[a] + n <= box_.hi[a] + margin;
      within[a] |= static_cast<std::uint32_t>(in) << n;
    }
  }
  std::uint64_t plane = 0;
  for (unsigned j = 0; j < 8; ++j) {
    if ((within[1] >> j & 1U) != 0) plane |= std::uint64_t{within[0]} << (8 * j);
  }
  Mask512 out{};
  for (std::size_t k = 0; k < 8; ++k) {
    out[k] = (within[2] >> k & 1U) != 0 ? plane : 0;
  }
  return out;
}

Mask512 SparsePlan::bits_of(const Index3& block) const {
  const Block found = index_.at(block);
  Mask512 out;
  if (found.leaf != Block::kConstant) {
    out = leaf_bits_[found.leaf];
  } else {
    out.fill(found.above ? ~std::uint64_t{0} : 0);
  }
  if (options_.region) {
    const Mask512 in = inside_region(block, 0);
    for (std::size_t k = 0; k < 8; ++k) {
      out[k] = (out[k] & in[k]) | (above_outside_ ? ~in[k] : 0);
    }
  }
  return out;
}

BlockBits SparsePlan::bits_around(const Index3& block) const {
  BlockBits out;
  for (std::size_t n = 0; n < 8; ++n) out[n] = bits_of(neighbour(block, n));
  return out;
}

BlockBits SparsePlan::exists_around(const Index3& block) const {
  BlockBits out;
  for (std::size_t n = 0; n < 8; ++n) {
    if (options_.region) {
      out[n] = inside_region(neighbour(block, n), capped_ ? 1 : 0);
    } else {
      out[n].fill(~std::uint64_t{0});
    }
  }
  return out;
}

void SparsePlan::count_blocks() {
  first_.resize(blocks_.size() + 1);
  n_triangles_.resize(blocks_.size());
  base::for_ranges(blocks_.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const BlockBits above = bits_around(blocks_[n]);
      const BlockBits exists = exists_around(blocks_[n]);
      first_[n + 1] = find_edges(above, exists).n_vertices;
      n_triangles_[n] =
          static_cast<std::uint16_t>(count_block_triangles(above, find_cells(above, exists)));
    }
  });
  for (std::size_t n = 0; n < blocks_.size(); ++n) first_[n + 1] += first_[n];
}

std::size_t SparsePlan::find(const Index3& block) const {
  const auto at = std::lower_bound(blocks_.begin(), blocks_.end(), block, before);
  return at != blocks_.end() && *at == block ? static_cast<std::size_t>(at - blocks_.begin())
                                             : kNone;
}

const BlockEdges& SparseExtractor::edges_of(std::size_t n) {
  if (cache_.empty()) cache_.resize(kCached);
  CachedEdges& slot = cache_[n % kCached];
  if (slot.block != n) {
    const Index3& block = plan_.blocks_[n];
    slot.edges = find_edges(plan_.bits_around(block), plan_.exists_around(block));
    slot.block = n;
  }
  return slot.edges;
}

void SparseExtractor::emit_triangles(std::size_t n, std::uint64_t base, const BlockBits& above,
                                     const Mask512& cells, MeshChunk& chunk) {
  static const BlockEdges kNoEdges;
  const Index3& block = plan_.blocks_[n];
  std::array<BlockEdges, 8> copies;
  BlockNeighbours around;
  for (std::size_t d = 0; d < 8; ++d) {
    const std::size_t at = d == 0 ? n : plan_.find(neighbour(block, d));
    if (at == kNone) {
      around.edges[d] = &kNoEdges;
      continue;
    }
    copies[d] = edges_of(at);  // a copy: a later neighbour may take its place in the cache
    around.edges[d] = &copies[d];
    const std::uint64_t id = plan_.first_[at] - base;
    if (id > std::numeric_limits<std::uint32_t>::max() - copies[d].n_vertices) {
      throw Error(ErrorKind::limit, plan_.reader_.volume().name,
                  "a layer of blocks has more than 2^32-1 vertices", "use --region");
    }
    around.first[d] = static_cast<std::uint32_t>(id);
  }
  const std::size_t before = chunk.indices.size();
  chunk.indices.resize(before + 3 * std::size_t{plan_.n_triangles_[n]});
  const std::size_t written =
      emit_block(above, cells, around, plan_.placement_.flip, chunk.indices.data() + before);
  assert(before + written == chunk.indices.size());
  static_cast<void>(written);
}

/// Sides of triangles in the faces of an open region: half the crossed edges of each cell's outer
/// faces.
std::uint64_t SparseExtractor::boundary_edges(const Index3& block, const BlockBits& above,
                                              const Mask512& cells) const {
  if (!plan_.options_.region || plan_.capped_) return 0;
  const IndexBox& box = plan_.box_;
  const Index3 o = origin_of(block);
  const auto bit = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const auto n = static_cast<std::size_t>((i >> 3) + 2 * (j >> 3) + 4 * (k >> 3));
    return above[n][static_cast<std::size_t>(k & 7)] >> ((j & 7) * 8 + (i & 7)) & 1U;
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
            corner[static_cast<std::size_t>(c)] = bit(p[0], p[1], p[2]);
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
template <class Writer>
void SparseExtractor::write_vertices(const BlockEdges& edges, const Index3& origin,
                                     Writer& writer) {
  for (std::int32_t k = 0; k < 8; ++k) {
    const auto write = [&](std::uint64_t crossed, int axis) {
      for_each_bit(crossed, [&](int at) {
        writer.write({{origin[0] + (at & 7), origin[1] + (at >> 3), origin[2] + k}, axis});
      });
    };
    const auto w = static_cast<std::size_t>(k);
    for (unsigned j = 0; j < 8; ++j) {
      const std::uint64_t row = std::uint64_t{0xFF} << (8 * j);
      write(edges.i[w] & row, 0);
      write(edges.j[w] & row, 1);
    }
    write(edges.k[w], 2);
  }
}

template <class T>
void SparseExtractor::extract_typed(std::size_t first, std::size_t last, MeshChunk& chunk,
                                    TaskTotals& totals) {
  using Sampler = BlockSampler<T>;
  leaf_scratch_.resize(27 * kLeafBytes);
  Sampler sampler(plan_.reader_, plan_.index_, plan_.box_, leaf_scratch_.data());
  VertexRules<T> rules(plan_.options_, plan_.to_world_, plan_.threshold_);
  rules.capped = plan_.capped_ && plan_.options_.region.has_value();
  const EdgeVertices<T, Sampler> vertices(rules, sampler);
  VertexWriter<T, Sampler> writer(rules, sampler, plan_.options_.precision,
                                  std::get<EdgeBatch<Real<T>>>(batches_), chunk, totals.bounds);
  const std::uint64_t base = plan_.first_[first];
  for (std::size_t n = first; n < last; ++n) {
    const Index3& block = plan_.blocks_[n];
    const Index3 o = origin_of(block);
    sampler.move_to(block);
    if (plan_.first_[n + 1] != plan_.first_[n]) {
      write_vertices(edges_of(n), o, writer);
      writer.flush();  // while the sampler is here
    }
    if (plan_.n_triangles_[n] == 0) continue;
    const BlockBits above = plan_.bits_around(block);
    const Mask512 cells = find_cells(above, plan_.exists_around(block));
    emit_triangles(n, base, above, cells, chunk);
    totals.n_boundary_edges += boundary_edges(block, above, cells);
    if (plan_.options_.measure) {
      LayerSum sum;
      for (std::int32_t k = 0; k < 8; ++k) {
        for_each_bit(cells[static_cast<std::size_t>(k)], [&](int at) {
          const Index3 cell{o[0] + (at & 7), o[1] + (at >> 3), o[2] + k};
          add_cell(vertices, plan_.placement_, cell, kCases[vertices.case_of(cell)], plan_.apex_,
                   sum);
        });
      }
      totals.layers.push_back(sum);
    }
  }
  totals.n_vertices = chunk.n_vertices();
  totals.n_triangles = chunk.n_triangles();
}

void SparseExtractor::extract(std::size_t first, std::size_t last, MeshChunk& chunk,
                              TaskTotals& totals) {
  chunk.clear();
  totals.clear();
  field::visit_type(plan_.threshold_.type, [&]<class T>(field::TypeTag<T> /*tag*/) {
    extract_typed<T>(first, last, chunk, totals);
  });
}

void SparseExtractor::count(std::size_t first, std::size_t last, TaskTotals& totals) const {
  totals.clear();
  totals.n_vertices = plan_.first_[last] - plan_.first_[first];
  for (std::size_t n = first; n < last; ++n) totals.n_triangles += plan_.n_triangles_[n];
}

}  // namespace mc::extraction
