// SPDX-License-Identifier: MIT
#include "extract/block_index.hpp"

#include <algorithm>
#include <bit>

namespace mc::extraction {

namespace {

constexpr std::int32_t kNodeSamples = 64;  // a node is 8 blocks of 8 samples wide
constexpr std::int32_t kBigTile = 1024;    // tiles from here on are not cut into nodes
constexpr std::uint64_t kColumn0 = 0x0101010101010101ULL;  // x = 0 in every row

std::uint64_t hash_of(const Index3& p) {
  std::uint64_t h = static_cast<std::uint32_t>(p[0]) * 0x9E3779B97F4A7C15ULL;
  h = (h ^ (h >> 29U)) + static_cast<std::uint32_t>(p[1]) * 0xBF58476D1CE4E5B9ULL;
  h = (h ^ (h >> 31U)) + static_cast<std::uint32_t>(p[2]) * 0x94D049BB133111EBULL;
  return h ^ (h >> 32U);
}

Index3 plus(const Index3& p, std::int32_t x, std::int32_t y, std::int32_t z) {
  return {p[0] + x, p[1] + y, p[2] + z};
}

/// Word and bit of a block in its node.
struct BitPlace {
  std::size_t word;
  unsigned bit;
};
BitPlace place_in_node(const Index3& block) {
  return {static_cast<std::size_t>(block[2] & 7),
          static_cast<unsigned>((block[1] & 7) * 8 + (block[0] & 7))};
}
bool test(const Mask512& mask, BitPlace p) { return ((mask[p.word] >> p.bit) & 1U) != 0; }
void set(Mask512& mask, BitPlace p) { mask[p.word] |= std::uint64_t{1} << p.bit; }

Mask512 operator|(const Mask512& a, const Mask512& b) {
  Mask512 out;
  for (std::size_t w = 0; w < 8; ++w) out[w] = a[w] | b[w];
  return out;
}

/// Bits of the neighbours at +x, +y, +z: `next` is the node on that side.
Mask512 from_x(const Mask512& m, const Mask512& next) {
  Mask512 out;
  for (std::size_t w = 0; w < 8; ++w) {
    out[w] = ((m[w] & ~kColumn0) >> 1) | ((next[w] & kColumn0) << 7);
  }
  return out;
}
Mask512 from_y(const Mask512& m, const Mask512& next) {
  Mask512 out;
  for (std::size_t w = 0; w < 8; ++w) out[w] = (m[w] >> 8) | (next[w] << 56);
  return out;
}
Mask512 from_z(const Mask512& m, const Mask512& next) {
  return {m[1], m[2], m[3], m[4], m[5], m[6], m[7], next[0]};
}

/// For each block: whether any of the 2x2x2 blocks from it upwards is set. m[x + 2y + 4z] are
/// nodes.
Mask512 any_upwards(const std::array<Mask512, 8>& m) {
  std::array<Mask512, 4> x;
  for (std::size_t n = 0; n < 4; ++n) x[n] = m[2 * n] | from_x(m[2 * n], m[2 * n + 1]);
  const Mask512 y0 = x[0] | from_y(x[0], x[1]);
  const Mask512 y1 = x[2] | from_y(x[2], x[3]);
  return y0 | from_z(y0, y1);
}

}  // namespace

BlockIndex::BlockIndex(const LeafReader& reader, const Threshold& threshold) {
  const auto above = [&](const Scalar& value) {
    return field::visit_type(threshold.type, [&]<class T>(field::TypeTag<T> /*tag*/) {
      return is_above(value.as<T>(), threshold);
    });
  };
  background_ = {reader.background(), above(reader.background())};
  slots_.resize(64);
  for (const Index3& origin : reader.leaves()) {
    const Index3 block = block_of(origin);
    set(nodes_[node_at(block_of(block))].leaf, place_in_node(block));
  }
  for (const Tile& tile : reader.tiles()) {
    constants_.push_back({tile.value, above(tile.value)});
    add_tile(tile, static_cast<std::uint32_t>(constants_.size() - 1));
  }
  std::sort(big_tiles_.begin(), big_tiles_.end(),
            [](const BigTile& a, const BigTile& b) { return before(a.origin, b.origin); });
  fill_entries(reader);
}

void BlockIndex::add_tile(const Tile& tile, std::uint32_t constant) {
  const bool odd = constants_[constant].above != background_.above;
  if (tile.size >= kBigTile) {
    const Index3 origin = block_of(block_of(tile.origin));
    big_tiles_.push_back({origin, tile.size / kNodeSamples, constant});
    if (std::find(big_sizes_.begin(), big_sizes_.end(), tile.size / kNodeSamples) ==
        big_sizes_.end()) {
      big_sizes_.push_back(tile.size / kNodeSamples);
    }
    return;
  }
  const Index3 first = block_of(tile.origin);
  const std::int32_t n = tile.size / 8;
  for (std::int32_t z = 0; z < n; ++z) {
    for (std::int32_t y = 0; y < n; ++y) {
      for (std::int32_t x = 0; x < n; ++x) {
        const Index3 block = plus(first, x, y, z);
        Node& node = nodes_[node_at(block_of(block))];
        set(node.tile, place_in_node(block));
        if (odd) set(node.odd, place_in_node(block));
      }
    }
  }
}

/// Where the entry of a leaf or tile block is: behind those of the node's lower bits.
std::uint32_t BlockIndex::entry_of(const Node& node, const Index3& block) {
  const BitPlace p = place_in_node(block);
  std::uint32_t rank = node.first;
  for (std::size_t w = 0; w < p.word; ++w) {
    rank += static_cast<std::uint32_t>(std::popcount(node.leaf[w] | node.tile[w]));
  }
  const std::uint64_t below = (std::uint64_t{1} << p.bit) - 1;
  return rank +
         static_cast<std::uint32_t>(std::popcount((node.leaf[p.word] | node.tile[p.word]) & below));
}

/// Puts the numbers of leaves and tiles behind their nodes, in the order of their bits.
void BlockIndex::fill_entries(const LeafReader& reader) {
  std::uint32_t n = 0;
  for (Node& node : nodes_) {
    node.first = n;
    for (std::size_t w = 0; w < 8; ++w) {
      n += static_cast<std::uint32_t>(std::popcount(node.leaf[w] | node.tile[w]));
    }
  }
  entries_.resize(n);
  const auto put = [&](const Index3& block, std::uint32_t number) {
    const Node& node = *find(block_of(block));
    entries_[entry_of(node, block)] = number;
  };
  for (std::size_t leaf = 0; leaf < reader.leaves().size(); ++leaf) {
    put(block_of(reader.leaves()[leaf]), static_cast<std::uint32_t>(leaf));
  }
  for (std::size_t t = 0; t < reader.tiles().size(); ++t) {
    const Tile& tile = reader.tiles()[t];
    const Index3 first = block_of(tile.origin);
    const std::int32_t width = tile.size >= kBigTile ? 0 : tile.size / 8;
    for (std::int32_t z = 0; z < width; ++z) {
      for (std::int32_t y = 0; y < width; ++y) {
        for (std::int32_t x = 0; x < width; ++x) {
          put(plus(first, x, y, z), static_cast<std::uint32_t>(t));
        }
      }
    }
  }
}

const BlockIndex::Node* BlockIndex::find(const Index3& key) const {
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t s = hash_of(key) & mask; slots_[s] != 0; s = (s + 1) & mask) {
    const Node& node = nodes_[slots_[s] - 1];
    if (node.key == key) return &node;
  }
  return nullptr;
}

std::uint32_t BlockIndex::node_at(const Index3& key) {
  if (const Node* node = find(key); node != nullptr) {
    return static_cast<std::uint32_t>(node - nodes_.data());
  }
  if (2 * (nodes_.size() + 1) > slots_.size()) grow();
  nodes_.emplace_back().key = key;
  const std::size_t mask = slots_.size() - 1;
  std::size_t s = hash_of(key) & mask;
  while (slots_[s] != 0) s = (s + 1) & mask;
  slots_[s] = static_cast<std::uint32_t>(nodes_.size());
  return slots_[s] - 1;
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

std::optional<std::uint32_t> BlockIndex::big_tile_at(const Index3& key) const {
  for (const std::int32_t size : big_sizes_) {  // tiles lie at multiples of their size
    const auto down = [size](std::int32_t x) { return x - ((x % size) + size) % size; };
    const Index3 origin{down(key[0]), down(key[1]), down(key[2])};
    const auto found =
        std::lower_bound(big_tiles_.begin(), big_tiles_.end(), origin,
                         [](const BigTile& t, const Index3& p) { return before(t.origin, p); });
    if (found != big_tiles_.end() && found->origin == origin && found->size == size) {
      return found->constant;
    }
  }
  return std::nullopt;
}

Block BlockIndex::at(const Index3& block) const {
  const Node* node = find(block_of(block));
  const BitPlace p = place_in_node(block);
  if (node != nullptr && (test(node->leaf, p) || test(node->tile, p))) {
    const std::uint32_t rank = entry_of(*node, block);
    if (test(node->leaf, p)) {
      return {entries_[rank], {}, false};
    }
    const Constant& c = constants_[entries_[rank]];
    return {Block::kConstant, c.value, c.above};
  }
  if (!big_tiles_.empty()) {
    if (const auto constant = big_tile_at(block_of(block)); constant) {
      return {Block::kConstant, constants_[*constant].value, constants_[*constant].above};
    }
  }
  return {Block::kConstant, background_.value, background_.above};
}

BlockIndex::Sides BlockIndex::sides_of(const Index3& key) const {
  Sides s{};
  if (const Node* node = find(key); node != nullptr) {
    s.leaf = node->leaf;
    s.odd = node->odd;
  } else if (const auto constant = big_tile_at(key);
             constant && constants_[*constant].above != background_.above) {
    s.odd.fill(~std::uint64_t{0});
  }
  for (std::size_t w = 0; w < 8; ++w) s.even[w] = ~(s.leaf[w] | s.odd[w]);
  return s;
}

/// Nodes whose blocks may be candidates: those with leaves or odd blocks, the faces of odd big
/// tiles, and the lower neighbours of both.
std::vector<Index3> BlockIndex::candidate_nodes() const {
  std::vector<Index3> keys;
  const auto add_with_lower = [&](const Index3& key) {
    for (std::int32_t n = 0; n < 8; ++n)
      keys.push_back(plus(key, -(n & 1), -(n >> 1 & 1), -(n >> 2)));
  };
  for (const Node& node : nodes_) {
    std::uint64_t any = 0;
    for (std::size_t w = 0; w < 8; ++w) any |= node.leaf[w] | node.odd[w];
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
  std::sort(keys.begin(), keys.end(), before);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

std::vector<Index3> BlockIndex::candidates() const {
  std::vector<Index3> blocks;
  for (const Index3& key : candidate_nodes()) {
    std::array<Mask512, 8> leaf;
    std::array<Mask512, 8> odd;
    std::array<Mask512, 8> even;
    for (std::int32_t n = 0; n < 8; ++n) {
      const Sides s = sides_of(plus(key, n & 1, n >> 1 & 1, n >> 2));
      const auto at = static_cast<std::size_t>(n);
      leaf[at] = s.leaf;
      odd[at] = s.odd;
      even[at] = s.even;
    }
    const Mask512 any_leaf = any_upwards(leaf);
    const Mask512 any_odd = any_upwards(odd);
    const Mask512 any_even = any_upwards(even);
    for (std::size_t w = 0; w < 8; ++w) {
      for (std::uint64_t m = any_leaf[w] | (any_odd[w] & any_even[w]); m != 0; m &= m - 1) {
        const std::int32_t bit = std::countr_zero(m);
        blocks.push_back({key[0] * 8 + (bit & 7), key[1] * 8 + (bit >> 3),
                          key[2] * 8 + static_cast<std::int32_t>(w)});
      }
    }
  }
  std::sort(blocks.begin(), blocks.end(), before);
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
  return nodes_.capacity() * sizeof(Node) + (slots_.capacity() + entries_.capacity()) * 4 +
         constants_.capacity() * sizeof(Constant) + big_tiles_.capacity() * sizeof(BigTile);
}

}  // namespace mc::extraction
