// SPDX-License-Identifier: MIT
#include "extract/sparse/block_index.hpp"

#include <algorithm>
#include <bit>

namespace mc::extraction {

using field::n_ones;
using field::rank_in;
using field::set;

namespace {

constexpr std::int32_t kNodeSamples = 64;  // a node is 8 blocks of 8 samples wide

std::size_t hash_of(const Index3& key) { return field::IndexHash{}(key); }

Index3 plus(const Index3& p, std::int32_t x, std::int32_t y, std::int32_t z) {
  return {p[0] + x, p[1] + y, p[2] + z};
}

/// Tiles that are whole nodes are not cut into blocks.
bool is_big(const Tile& tile) { return tile.size > kNodeSamples && tile.size % kNodeSamples == 0; }

/// Calls f for every block of a tile.
template <class F>
void for_each_block(const Tile& tile, F&& f) {
  const Index3 first = block_of(tile.origin);
  const std::int32_t n = tile.size / 8;
  for (std::int32_t z = 0; z < n; ++z) {
    for (std::int32_t y = 0; y < n; ++y) {
      for (std::int32_t x = 0; x < n; ++x) f(plus(first, x, y, z));
    }
  }
}

bool above(const Scalar& value, const Threshold& threshold) {
  return field::visit_type(threshold.type, [&]<class T>(field::TypeTag<T> /*tag*/) {
    return is_above(value.as<T>(), threshold);
  });
}

}  // namespace

BlockIndex::BlockIndex(const LeafReader& reader, const Threshold& threshold) {
  slots_.resize(64);
  constants_.push_back({reader.background(), above(reader.background(), threshold)});
  background_ = constants_.front();
  add_leaves(reader.leaves());
  add_tiles(reader.tiles(), threshold);
}

std::uint32_t BlockIndex::constant_of(const Scalar& value, const Threshold& threshold) {
  if (!(constants_.back().value == value)) constants_.push_back({value, above(value, threshold)});
  return static_cast<std::uint32_t>(constants_.size() - 1);
}

void BlockIndex::add_leaves(std::span<const Index3> origins) {
  for (const Index3& origin : origins) {
    const Index3 block = block_of(origin);
    set(nodes_[node_at(block_of(block))].leaf, bit_index(block));
  }
  const auto number_nodes = [this] {
    std::uint32_t n = 0;
    for (Node& node : nodes_) {
      node.leaves = n;
      for (std::size_t w = 0; w < 8; ++w) {
        node.leaves_before[w] = static_cast<std::uint16_t>(n - node.leaves);
        n += static_cast<std::uint32_t>(std::popcount(node.leaf[w]));
      }
    }
  };
  number_nodes();
  leaf_entries_.resize(origins.size());
  for (std::size_t leaf = 0; leaf < origins.size(); ++leaf) {
    // A node's leaves come in the order of its bits, as all leaves are ordered by (z, y, x).
    Node& node = nodes_[node_at(block_of(block_of(origins[leaf])))];
    leaf_entries_[node.leaves++] = static_cast<std::uint32_t>(leaf);
  }
  number_nodes();
}

void BlockIndex::add_tiles(std::span<const Tile> tiles, const Threshold& threshold) {
  for (const Tile& tile : tiles) add_tile(tile, constant_of(tile.value, threshold));
  std::sort(big_tiles_.begin(), big_tiles_.end(),
            [](const BigTile& a, const BigTile& b) { return comes_before(a.origin, b.origin); });
  number_tiles(tiles);
}

/// Where tiles of different values share a node, each block says which it is of.
void BlockIndex::number_tiles(std::span<const Tile> tiles) {
  std::uint32_t n = 0;
  for (Node& node : nodes_) {
    if (node.constant != kVarious) continue;
    node.tiles = n;
    n += n_ones(node.tile);
  }
  if (n == 0) return;
  tile_entries_.resize(n);
  std::uint32_t constant = 0;
  for (const Tile& tile : tiles) {
    while (!(constants_[constant].value == tile.value)) ++constant;  // as constant_of() made them
    if (is_big(tile)) continue;
    for_each_block(tile, [&](const Index3& block) {
      const Node& node = nodes_[node_at(block_of(block))];
      if (node.constant != kVarious) return;
      tile_entries_[node.tiles + rank_in(node.tile, bit_index(block))] = constant;
    });
  }
}

void BlockIndex::add_tile(const Tile& tile, std::uint32_t constant) {
  if (is_big(tile)) {
    const std::int32_t size = tile.size / kNodeSamples;
    big_tiles_.push_back({block_of(block_of(tile.origin)), size, constant});
    if (std::find(big_sizes_.begin(), big_sizes_.end(), size) == big_sizes_.end()) {
      big_sizes_.push_back(size);
    }
    return;
  }
  const bool odd = constants_[constant].above != background_.above;
  for_each_block(tile, [&](const Index3& block) {
    Node& node = nodes_[node_at(block_of(block))];
    const bool same = node.constant == kNoTile || node.constant == constant;
    node.constant = same ? constant : kVarious;
    set(node.tile, bit_index(block));
    if (odd) set(node.odd, bit_index(block));
  });
}

const BlockIndex::Node* BlockIndex::find(const Index3& key) const {
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t s = hash_of(key) & mask; slots_[s] != 0; s = (s + 1) & mask) {
    const Node& node = nodes_[slots_[s] - 1];
    if (same(node.key, key)) return &node;
  }
  return nullptr;
}

std::uint32_t BlockIndex::node_at(const Index3& key) {
  if (last_ < nodes_.size() && same(nodes_[last_].key, key)) return last_;
  if (const Node* node = find(key); node != nullptr) {
    return last_ = static_cast<std::uint32_t>(node - nodes_.data());
  }
  if (2 * (nodes_.size() + 1) > slots_.size()) grow();
  nodes_.emplace_back().key = key;
  const std::size_t mask = slots_.size() - 1;
  std::size_t s = hash_of(key) & mask;
  while (slots_[s] != 0) s = (s + 1) & mask;
  slots_[s] = static_cast<std::uint32_t>(nodes_.size());
  return last_ = slots_[s] - 1;
}

void BlockIndex::grow() {
  slots_.assign(2 * slots_.size(), 0);
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    std::size_t s = hash_of(nodes_[n].key) & mask;
    while (slots_[s] != 0) s = (s + 1) & mask;
    slots_[s] = static_cast<std::uint32_t>(n + 1);
  }
}

std::optional<std::size_t> BlockIndex::big_tile_number(const Index3& key) const {
  for (const std::int32_t size : big_sizes_) {  // tiles lie at multiples of their size
    const auto down = [size](std::int32_t x) { return x - ((x % size) + size) % size; };
    const Index3 origin{down(key[0]), down(key[1]), down(key[2])};
    const auto found = std::lower_bound(
        big_tiles_.begin(), big_tiles_.end(), origin,
        [](const BigTile& t, const Index3& p) { return comes_before(t.origin, p); });
    if (found != big_tiles_.end() && found->origin == origin && found->size == size) {
      return static_cast<std::size_t>(found - big_tiles_.begin());
    }
  }
  return std::nullopt;
}

std::vector<BlockIndex::UniformBlocks> BlockIndex::uniform_blocks() const {
  std::vector<UniformBlocks> out;
  out.reserve(nodes_.size());
  for (const Node& node : nodes_) {
    UniformBlocks& blocks = out.emplace_back();
    blocks.node = node.key;
    for (std::size_t w = 0; w < 8; ++w) {
      const std::uint64_t usual = ~(node.mixed[w] | node.odd[w]);
      blocks.above[w] = background_.above ? usual : node.odd[w];
      blocks.below[w] = background_.above ? node.odd[w] : usual;
    }
  }
  std::sort(out.begin(), out.end(), [](const UniformBlocks& a, const UniformBlocks& b) {
    return comes_before(a.node, b.node);
  });
  return out;
}

std::vector<BlockIndex::UniformNodes> BlockIndex::big_tiles() const {
  std::vector<UniformNodes> out;
  for (const BigTile& tile : big_tiles_) {
    out.push_back({tile.origin, tile.size, constants_[tile.constant].above});
  }
  return out;
}

Block BlockIndex::at(const Index3& block) const {
  const auto constant = [&](std::uint32_t n) {
    return Block{Block::kConstant, constants_[n].value, constants_[n].above};
  };
  const BitIndex p = bit_index(block);
  if (const Node* node = find(block_of(block)); node != nullptr) {
    if (test(node->leaf, p)) {
      const std::uint64_t before = node->leaf[p.word] & ((std::uint64_t{1} << p.bit) - 1);
      return {leaf_entries_[node->leaves + node->leaves_before[p.word] +
                            static_cast<std::uint32_t>(std::popcount(before))],
              {},
              false};
    }
    if (!test(node->tile, p)) return constant(0);
    return constant(node->constant != kVarious
                        ? node->constant
                        : tile_entries_[node->tiles + rank_in(node->tile, p)]);
  }
  return constant(big_tile_at(block_of(block)).value_or(0));
}

void BlockIndex::set_sides(std::span<const LeafSide> leaves) {
  const LeafSide usual = background_.above ? LeafSide::above : LeafSide::below;
  for (Node& node : nodes_) {
    const std::uint32_t* leaf = leaf_entries_.data() + node.leaves;
    for (std::size_t w = 0; w < 8; ++w) {
      for (std::uint64_t m = node.leaf[w]; m != 0; m &= m - 1) {
        const LeafSide side = leaves[*leaf++];
        const std::uint64_t bit = m & (~m + 1);
        if (side == LeafSide::mixed) {
          node.mixed[w] |= bit;
        } else if (side != usual) {
          node.odd[w] |= bit;
        }
      }
    }
  }
}

BlockIndex::Sides BlockIndex::sides_of(const Index3& key) const {
  Sides s{};
  if (const Node* node = find(key); node != nullptr) {
    s.mixed = node->mixed;
    s.odd = node->odd;
  } else if (const auto constant = big_tile_at(key);
             constant && constants_[*constant].above != background_.above) {
    s.odd.fill(~std::uint64_t{0});
  }
  for (std::size_t w = 0; w < 8; ++w) s.even[w] = ~(s.mixed[w] | s.odd[w]);
  return s;
}

/// Nodes whose blocks may be candidates: those with mixed or odd blocks, the faces of odd big
/// tiles, and the lower neighbours of both.
std::vector<Index3> BlockIndex::candidate_nodes() const {
  std::vector<Index3> keys;
  const auto add_with_lower = [&](const Index3& key) {
    for (std::int32_t n = 0; n < 8; ++n)
      keys.push_back(plus(key, -(n & 1), -(n >> 1 & 1), -(n >> 2)));
  };
  for (const Node& node : nodes_) {
    std::uint64_t any = 0;
    for (std::size_t w = 0; w < 8; ++w) any |= node.mixed[w] | node.odd[w];
    if (any != 0) add_with_lower(node.key);
  }
  for (const BigTile& t : big_tiles_) {
    if (constants_[t.constant].above == background_.above) continue;
    for (std::int32_t z = -1; z < t.size; ++z) {
      for (std::int32_t y = -1; y < t.size; ++y) {
        const bool face = z == -1 || z == t.size - 1 || y == -1 || y == t.size - 1;
        for (std::int32_t x = -1; x < t.size; x += face ? 1 : t.size) {
          keys.push_back(plus(t.origin, x, y, z));
        }
      }
    }
  }
  std::sort(keys.begin(), keys.end(), comes_before);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

BlockIndex::NodeCandidates BlockIndex::candidates_in(const Index3& key) const {
  std::array<Mask512, 8> mixed;
  std::array<Mask512, 8> odd;
  std::array<Mask512, 8> even;
  for (std::int32_t n = 0; n < 8; ++n) {
    const Sides s = sides_of(plus(key, n & 1, n >> 1 & 1, n >> 2));
    const auto at = static_cast<std::size_t>(n);
    mixed[at] = s.mixed;
    odd[at] = s.odd;
    even[at] = s.even;
  }
  NodeCandidates out{key, any_upwards(mixed), mixed[0], {}};
  const Mask512 any_odd = any_upwards(odd);
  const Mask512 any_even = any_upwards(even);
  for (std::size_t w = 0; w < 8; ++w) out.blocks[w] |= any_odd[w] & any_even[w];
  const std::array<Mask512, 8>& m = background_.above ? even : odd;
  std::array<Mask512, 8> plane;  // both z: moved by nothing, x, y, x and y
  for (std::size_t z = 0; z < 8; z += 4) {
    plane[z] = m[z];
    plane[z + 1] = from_x(m[z], m[z + 1]);
    plane[z + 2] = from_y(m[z], m[z + 2]);
    plane[z + 3] = from_y(plane[z + 1], from_x(m[z + 2], m[z + 3]));
  }
  for (std::size_t n = 0; n < 4; ++n) {
    out.above[n] = plane[n];
    out.above[n + 4] = from_z(plane[n], plane[n + 4]);
  }
  return out;
}

std::vector<SurfaceBlock> BlockIndex::candidates() const {
  const std::vector<Index3> keys = candidate_nodes();
  std::vector<SurfaceBlock> blocks;
  std::vector<NodeCandidates> layer;
  // A row of blocks runs through all nodes of a row of nodes, a plane of blocks through a layer.
  const auto add_row = [&](const NodeCandidates& node, std::size_t w, unsigned y) {
    for (std::uint64_t m = node.blocks[w] >> (8 * y) & 0xFFU; m != 0; m &= m - 1) {
      const int x = std::countr_zero(m);
      const unsigned bit = 8 * y + static_cast<unsigned>(x);
      SurfaceBlock block;
      block.at =
          plus(origin_of(node.key), x, static_cast<std::int32_t>(y), static_cast<std::int32_t>(w));
      for (std::size_t n = 0; n < 8; ++n) {
        block.above |= static_cast<std::uint8_t>((node.above[n][w] >> bit & 1U) << n);
      }
      block.bits = (node.mixed[w] >> bit & 1U) != 0 ? SurfaceBlock::kMixed
                   : (block.above & 1U) != 0        ? SurfaceBlock::kAbove
                                                    : SurfaceBlock::kBelow;
      blocks.push_back(block);
    }
  };
  for (std::size_t first = 0; first < keys.size();) {
    std::size_t last = first;
    layer.clear();
    for (; last < keys.size() && keys[last][2] == keys[first][2]; ++last) {
      layer.push_back(candidates_in(keys[last]));
    }
    for (std::size_t w = 0; w < 8; ++w) {
      for (std::size_t row = 0, end = 0; row < layer.size(); row = end) {
        while (end < layer.size() && layer[end].key[1] == layer[row].key[1]) ++end;
        for (unsigned y = 0; y < 8; ++y) {
          for (std::size_t node = row; node < end; ++node) add_row(layer[node], w, y);
        }
      }
    }
    first = last;
  }
  return blocks;
}

IndexBox BlockIndex::stored_blocks() const {
  IndexBox nodes{{0, 0, 0}, {-1, -1, -1}};
  bool first = true;
  const auto include = [&](const Index3& lo, std::int32_t width) {
    for (std::size_t a = 0; a < 3; ++a) {
      nodes.lo[a] = first ? lo[a] : std::min(nodes.lo[a], lo[a]);
      nodes.hi[a] = first ? lo[a] + width - 1 : std::max(nodes.hi[a], lo[a] + width - 1);
    }
    first = false;
  };
  for (const Node& node : nodes_) include(node.key, 1);
  for (const BigTile& tile : big_tiles_) include(tile.origin, tile.size);
  for (std::size_t a = 0; a < 3; ++a) {
    nodes.lo[a] *= 8;
    nodes.hi[a] = nodes.hi[a] * 8 + 7;
  }
  return nodes;
}

std::uint64_t BlockIndex::bytes() const {
  return nodes_.capacity() * sizeof(Node) +
         (slots_.capacity() + leaf_entries_.capacity() + tile_entries_.capacity()) * 4 +
         constants_.capacity() * sizeof(Constant) + big_tiles_.capacity() * sizeof(BigTile);
}

}  // namespace mc::extraction
