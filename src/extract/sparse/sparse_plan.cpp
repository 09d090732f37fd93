// SPDX-License-Identifier: MIT
#include "extract/sparse/sparse_plan.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "base/parallel.hpp"
#include "extract/bits/classify.hpp"
#include "extract/sparse/leaf_queue.hpp"

namespace mc::extraction {

using field::kBlockSize;

namespace {

/// No vertices, nor cells of its own: not a block of the surface.
constexpr std::uint16_t kNothing = 0xFFFF;

Index3 neighbour(const Index3& block, std::size_t n) {
  return {block[0] + static_cast<std::int32_t>(n & 1U),
          block[1] + static_cast<std::int32_t>(n >> 1U & 1U),
          block[2] + static_cast<std::int32_t>(n >> 2U)};
}

/// More layers than there are, with space for the neighbours of the last.
constexpr LayerRange kAllLayers{-kReach, kReach};

LeafSide side_of(const Mask512& bits) {
  std::uint64_t any = 0;
  std::uint64_t all = ~std::uint64_t{0};
  for (const std::uint64_t word : bits) {
    any |= word;
    all &= word;
  }
  return any == 0 ? LeafSide::below : all + 1 == 0 ? LeafSide::above : LeafSide::mixed;
}

}  // namespace

const Mask512 SparsePlan::kAllBelow{};
const Mask512 SparsePlan::kAllAbove = [] {
  Mask512 all;
  all.fill(~std::uint64_t{0});
  return all;
}();

LayerRange block_layers(const LeafReader& reader, const ExtractOptions& options) {
  LayerRange layers{kReach, -kReach};
  const auto include = [&](std::int32_t lowest, std::int32_t size) {
    layers.first = std::min(layers.first, block_of(lowest) - 1);  // its cells end in the block
    layers.last = std::max(layers.last, block_of(lowest) + size / kBlockSize);
  };
  for (const Tile& tile : reader.tiles()) include(tile.origin[2], tile.size);
  if (const auto leaves = reader.leaves(); !leaves.empty()) {
    include(leaves.front()[2], kBlockSize);
    include(leaves.back()[2], kBlockSize);
  }
  if (options.region) {
    const bool capped = options.border != Border::open;
    const std::int32_t lo = block_of(options.region->lo[2] - (capped ? 1 : 0));
    const std::int32_t hi = block_of(options.region->hi[2] + (capped ? 1 : 0)) + 1;
    layers = capped ? LayerRange{lo, hi}
                    : LayerRange{std::max(layers.first, lo), std::min(layers.last, hi)};
  }
  return layers.first < layers.last ? layers : LayerRange{};
}

SparsePlan::SparsePlan(const LeafReader& reader, const ExtractOptions& options)
    : reader_(reader),
      options_(options),
      threshold_(reader.volume().type, std::endian::native, options.iso, options.inside),
      box_(options.region.value_or(kAllSamples)),
      capped_(options.region && options.border != Border::open),
      above_outside_((options.border == Border::solid) == (options.inside == Inside::above)),
      layers_(options.part.value_or(kAllLayers)),
      index_(reader, threshold_) {
  find_blocks(classify_leaves());
  if (options.selection != nullptr) leave_out(options.selection->sparse());
  count_vertices();
}

std::uint64_t SparsePlan::bytes() const {
  return index_.bytes() + pool_.bytes() + blocks_.size() * sizeof(SurfaceBlock) +
         first_.size() * sizeof(std::uint64_t);
}

std::uint64_t SparsePlan::first_vertex(std::size_t n) const {
  assert(n <= blocks_.size());
  std::uint64_t id = first_[n / kStride];
  for (std::size_t b = n / kStride * kStride; b < n; ++b) id += blocks_[b].n_vertices;
  return id;
}

LeafSide SparsePlan::classify_leaf(std::size_t n, const std::byte* values, Mask512& bits) const {
  Mask512 slices;
  classify_rows(threshold_,
                {values, LeafReader::kLeafSamples * sample_size(threshold_.type),
                 LeafReader::kLeafSamples, 1},
                slices.data(), slices.size());
  LeafSide side = side_of(slices);
  if (capped_) {
    const Mask512 in = inside_region(block_of(reader_.leaves()[n]), 0);
    bits = planes_of(slices);
    for (std::size_t k = 0; k < 8; ++k) {
      bits[k] = (bits[k] & in[k]) | (above_outside_ ? ~in[k] : 0);
    }
    side = side_of(bits);
  } else if (side == LeafSide::mixed) {
    bits = planes_of(slices);
  }
  return side;
}

std::vector<LeafSide> SparsePlan::classify_leaves() {
  const std::span<const Index3> leaves = reader_.leaves();
  std::vector<LeafSide> sides(leaves.size());  // those that no bits depend on: any
  const auto layer_of = [](const Index3& leaf) { return field::block_of(leaf[2]); };
  const auto lowest = std::ranges::lower_bound(leaves, layers_.first, {}, layer_of);
  const auto behind = std::partition_point(
      lowest, leaves.end(), [&](const Index3& leaf) { return reaches(layer_of(leaf)); });
  const auto first_leaf = static_cast<std::size_t>(lowest - leaves.begin());
  const auto n_leaves = static_cast<std::size_t>(behind - leaves.begin());
  pool_.resize((n_leaves - first_leaf + BitPool::kGroup - 1) / BitPool::kGroup);
  base::for_ranges(pool_.n_groups(), 1, [&](std::size_t begin, std::size_t end) {
    LeafQueue queue(reader_);
    std::size_t ahead = first_leaf + begin * BitPool::kGroup;
    const auto push = [&] {
      queue.push(ahead < n_leaves ? ahead : Block::kConstant);
      ++ahead;
    };
    for (std::size_t n = 0; n < LeafQueue::kAhead; ++n) push();
    std::vector<Mask512> mixed(BitPool::kGroup);
    for (std::size_t g = begin; g < end; ++g) {
      std::size_t n_mixed = 0;
      const std::size_t last = std::min(n_leaves, first_leaf + (g + 1) * BitPool::kGroup);
      for (std::size_t n = first_leaf + g * BitPool::kGroup; n < last; ++n) {
        sides[n] = classify_leaf(n, queue.pop(), mixed[n_mixed]);
        n_mixed += sides[n] == LeafSide::mixed ? 1 : 0;
        push();
      }
      pool_.group(g).assign(mixed.begin(), mixed.begin() + static_cast<std::ptrdiff_t>(n_mixed));
    }
  });
  return sides;
}

void SparsePlan::find_blocks(const std::vector<LeafSide>& sides) {
  index_.set_sides(sides);
  blocks_ = index_.candidates();
  check_reach();
  std::size_t group = 0;
  std::size_t n = 0;
  for (SurfaceBlock& block : blocks_) {  // in the order of the leaves, as in the pool
    if (block.bits != SurfaceBlock::kMixed) continue;
    while (n == pool_.group(group).size()) {
      ++group;
      n = 0;
    }
    block.bits = BitPool::place(group, n++);
  }
  std::erase_if(blocks_, [&](const SurfaceBlock& b) { return !reaches(b.at[2]); });
  if (capped_) {
    find_capped_blocks(sides);
  } else if (options_.region) {
    std::erase_if(blocks_, [&](const SurfaceBlock& b) { return !touches_region(b.at, 0); });
  }
}

void SparsePlan::check_reach() const {
  const auto reaches = [](std::int32_t x) { return x <= -kReach || x >= kReach; };
  bool too_far = options_.region &&
                 (std::ranges::any_of(box_.lo, reaches) || std::ranges::any_of(box_.hi, reaches));
  for (const SurfaceBlock& block : blocks_) {
    for (const std::int32_t x : block.at) too_far = too_far || reaches(x * 8);
  }
  if (too_far) {
    throw Error(ErrorKind::limit, reader_.volume().name,
                "the grid or region reaches past index +-2^30, beyond what can be extracted");
  }
}

/// With a closed border, constant blocks at the region's faces hold a surface too, and what lies
/// outside is as the border says. Blocks are looked up one by one.
void SparsePlan::find_capped_blocks(const std::vector<LeafSide>& sides) {
  std::vector<SurfaceBlock> inner;
  inner.swap(blocks_);
  std::erase_if(inner, [&](const SurfaceBlock& b) { return !touches_region(b.at, 1); });
  const std::vector<Index3> faces = region_faces();
  blocks_.resize(faces.size());
  for (std::size_t n = 0; n < faces.size(); ++n) blocks_[n].at = faces[n];
  blocks_.insert(blocks_.begin(), inner.begin(), inner.end());  // first where both name a block
  std::ranges::stable_sort(blocks_, [](const SurfaceBlock& a, const SurfaceBlock& b) {
    return comes_before(a.at, b.at);
  });
  const auto one = [](const SurfaceBlock& a, const SurfaceBlock& b) { return same(a.at, b.at); };
  blocks_.erase(std::unique(blocks_.begin(), blocks_.end(), one), blocks_.end());
  const auto constant_bits = [&](bool above, const Index3& block) {
    const Mask512 in = inside_region(block, 0);
    Mask512 bits;
    for (std::size_t k = 0; k < 8; ++k) {
      bits[k] = (above ? in[k] : 0) | (above_outside_ ? ~in[k] : 0);
    }
    return bits;
  };
  const auto bits_at = [&](const Index3& at, Mask512& bits) {
    const Block found = index_.at(at);
    if (found.leaf != Block::kConstant) return sides[found.leaf];
    bits = constant_bits(found.above, at);
    return side_of(bits);
  };
  for (SurfaceBlock& block : blocks_) {
    block.above = 0;
    Mask512 bits{};
    for (std::size_t n = 0; n < 8; ++n) {
      if (bits_at(neighbour(block.at, n), bits) == LeafSide::above) {
        block.above |= static_cast<std::uint8_t>(1U << n);
      }
    }
    const LeafSide side = bits_at(block.at, bits);
    if (side == LeafSide::mixed) {
      if (index_.at(block.at).leaf != Block::kConstant) continue;  // has its place
      if (pool_.n_groups() == 0 || pool_.group(pool_.n_groups() - 1).size() == BitPool::kGroup) {
        pool_.resize(pool_.n_groups() + 1);
      }
      std::vector<Mask512>& group = pool_.group(pool_.n_groups() - 1);
      group.push_back(bits);
      block.bits = BitPool::place(pool_.n_groups() - 1, group.size() - 1);
    } else {
      block.bits = side == LeafSide::above ? SurfaceBlock::kAbove : SurfaceBlock::kBelow;
    }
  }
}

/// The blocks at a region's faces: those of the outer layer, and of the samples next to it.
std::vector<Index3> SparsePlan::region_faces() const {
  Index3 lo = block_of({box_.lo[0] - 1, box_.lo[1] - 1, box_.lo[2] - 1});
  Index3 hi = block_of({box_.hi[0] + 1, box_.hi[1] + 1, box_.hi[2] + 1});
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
  lo[2] = std::max(lo[2], layers_.first);
  hi[2] = std::min(hi[2], layers_.last + 1);
  std::vector<Index3> faces;
  for (std::int32_t z = lo[2]; z <= hi[2]; ++z) {
    for (std::int32_t y = lo[1]; y <= hi[1]; ++y) {
      const bool face = z <= lo_in[2] || z >= hi_in[2] || y <= lo_in[1] || y >= hi_in[1];
      for (std::int32_t x = lo[0]; x <= hi[0]; ++x) {
        if (!face && x > lo_in[0] && x < hi_in[0]) {
          x = hi_in[0] - 1;
          continue;
        }
        faces.push_back({x, y, z});
      }
    }
  }
  return faces;
}

bool SparsePlan::touches_region(const Index3& block, std::int32_t margin) const {
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int32_t o = block[a] * 8;
    if (o + 7 < box_.lo[a] - margin || o > box_.hi[a] + margin) return false;
  }
  return true;
}

/// Ones for the samples of a block that lie in the region, or at most `margin` outside.
Mask512 SparsePlan::inside_region(const Index3& block, std::int32_t margin) const {
  std::array<std::uint32_t, 3> within{};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::int32_t n = 0; n < 8; ++n) {
      const std::int32_t at = block[a] * 8 + n;
      const bool in = at >= box_.lo[a] - margin && at <= box_.hi[a] + margin;
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

const BlockBits* SparsePlan::samples_around(const Index3& block, BlockSamples& out) const {
  if (!options_.region) return nullptr;
  const std::int32_t margin = capped_ ? 1 : 0;
  bool all = true;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int32_t o = block[a] * 8;
    all = all && o >= box_.lo[a] - margin && o + 8 <= box_.hi[a] + margin;
  }
  if (all) return nullptr;
  for (std::size_t n = 0; n < 8; ++n) {
    out.masks[n] = inside_region(neighbour(block, n), margin);
    out.bits[n] = &out.masks[n];
  }
  return &out.bits;
}

/// Makes components that are left out not solid, in the blocks and in what blocks say of their
/// neighbours.
void SparsePlan::leave_out(const SparseSelection& selection) {
  const bool solid_above = options_.inside == Inside::above;
  const std::uint32_t solid = solid_above ? SurfaceBlock::kAbove : SurfaceBlock::kBelow;
  const std::uint32_t other = solid_above ? SurfaceBlock::kBelow : SurfaceBlock::kAbove;
  base::for_ranges(blocks_.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (SurfaceBlock& block : std::span(blocks_).subspan(begin, end - begin)) {
      if (mixed_bits(block) != nullptr) {
        const Mask512* dropped = selection.samples(block.at);
        for (std::size_t w = 0; dropped != nullptr && w < dropped->size(); ++w) {
          pool_.at(block.bits)[w] ^= (*dropped)[w];
        }
      } else if (block.bits == solid && selection.drops(block.at)) {
        block.bits = other;
      }
      for (std::size_t n = 0; n < 8; ++n) {  // of neighbours that are no surface blocks
        const auto bit = static_cast<std::uint8_t>(1U << n);
        const bool above = (block.above & bit) != 0;
        if (above == solid_above && selection.drops(neighbour(block.at, n))) block.above ^= bit;
      }
    }
  });
}

/// Counts every block's vertices and drops the blocks without a surface.
void SparsePlan::count_vertices() {
  base::for_ranges(blocks_.size(), 1024, [&](std::size_t begin, std::size_t end) {
    BlockWalk<2> walk(blocks_);
    BlockSamples samples;
    for (std::size_t n = begin; n < end; ++n) {
      walk.move_to(n);
      const BlockBits above = bits_around(walk, 0, 0, 0);
      const bool crossed = side_of(find_cells(above, nullptr)) != LeafSide::below;
      const BlockBits* exists = samples_around(blocks_[n].at, samples);
      blocks_[n].n_vertices = crossed ? find_edges(above, exists).n_vertices : kNothing;
    }
  });
  std::erase_if(blocks_, [](const SurfaceBlock& b) { return b.n_vertices == kNothing; });
  const auto is_own = [&](const SurfaceBlock& b) { return b.at[2] < layers_.last; };
  n_own_ =
      static_cast<std::size_t>(std::ranges::partition_point(blocks_, is_own) - blocks_.begin());
  std::uint64_t id = 0;
  first_.reserve(blocks_.size() / kStride + 1);
  for (std::size_t n = 0; n < blocks_.size(); ++n) {
    if (n % kStride == 0) first_.push_back(id);
    id += blocks_[n].n_vertices;
  }
  if (blocks_.size() % kStride == 0) first_.push_back(id);
}

}  // namespace mc::extraction
