// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "extract/bits/threshold.hpp"
#include "extract/sparse/block_masks.hpp"
#include "mc/field.hpp"

// Where the blocks of a sparse volume are. A block is a cube of 8x8x8 samples; it is a leaf, or
// constant (part of a tile, or background). Nodes of 8x8x8 blocks hold one bit a block, so that the
// blocks which can hold a surface are found by word arithmetic too.

namespace mc::extraction {

using field::bit_index;
using field::BitIndex;
using field::block_of;  // of a block: its node
using field::comes_before;
using field::origin_of;
using field::same;
using field::test;

/// What a block is.
struct Block {
  static constexpr std::uint32_t kConstant = 0xFFFFFFFF;
  std::uint32_t leaf = kConstant;  ///< number of the leaf
  Scalar value;                    ///< of a constant block
  bool above = false;              ///< of a constant block
};

/// What the samples of a leaf are.
enum class LeafSide : std::uint8_t { below, above, mixed };

/// A block that may hold a surface.
struct SurfaceBlock {
  static constexpr std::uint32_t kMixed = 0xFFFFFFFD;  ///< to be replaced by a place
  static constexpr std::uint32_t kBelow = 0xFFFFFFFE;
  static constexpr std::uint32_t kAbove = 0xFFFFFFFF;
  Index3 at{};
  std::uint32_t bits = kBelow;   ///< where its sample bits are kept, or one of the above
  std::uint16_t n_vertices = 0;  ///< on the edges that start in it
  std::uint8_t above = 0;        ///< bit x + 2y + 4z: that upper neighbour is constant, and above
};

class BlockIndex {
 public:
  /// Cost: O(leaves + tiles), where a tile larger than a node counts by its surface.
  BlockIndex(const LeafReader& reader, const Threshold& threshold);

  [[nodiscard]] Block at(const Index3& block) const;

  /// Says of each leaf what its samples are; before candidates().
  void set_sides(std::span<const LeafSide> leaves);

  /// The blocks of a node that have samples of one side only; those in no leaf or tile count as
  /// background.
  struct UniformBlocks {
    Index3 node{};
    Mask512 above{}, below{};
  };
  /// Of all nodes that hold a leaf or a small tile, ordered by (z, y, x); after set_sides().
  [[nodiscard]] std::vector<UniformBlocks> uniform_blocks() const;
  /// A tile of whole nodes.
  struct UniformNodes {
    Index3 origin{};  ///< in nodes
    std::int32_t size = 0;
    bool above = false;
  };
  /// All of them, ordered by origin.
  [[nodiscard]] std::vector<UniformNodes> big_tiles() const;
  /// Which of big_tiles() holds a node.
  [[nodiscard]] std::optional<std::size_t> big_tile_number(const Index3& node) const;

  /// Every block of which, or of whose seven upper neighbours, one is mixed, or some are above and
  /// some below. Ordered by (z, y, x).
  [[nodiscard]] std::vector<SurfaceBlock> candidates() const;

  /// Blocks (inclusive) that hold every leaf and tile, up to a node's width more.
  [[nodiscard]] IndexBox stored_blocks() const;
  [[nodiscard]] bool background_above() const { return background_.above; }

  [[nodiscard]] std::uint64_t bytes() const;

 private:
  static constexpr std::uint32_t kVarious = 0xFFFFFFFF;
  static constexpr std::uint32_t kNoTile = 0xFFFFFFFE;
  struct Node {
    Index3 key{};                      ///< block index / 8
    Mask512 leaf{};                    ///< blocks that are leaves
    Mask512 mixed{};                   ///< leaves with samples on both sides
    Mask512 tile{};                    ///< blocks that are part of a tile
    Mask512 odd{};                     ///< not mixed, and on the other side than the background
    std::uint32_t leaves = 0;          ///< in leaf_entries_: numbers of its leaves, by rank
    std::uint32_t constant = kNoTile;  ///< of all its tiles, or kVarious
    std::array<std::uint16_t, 8> leaves_before{};  ///< each word of `leaf`
    std::uint32_t tiles = 0;  ///< in tile_entries_ where they are various, by rank
  };
  struct Constant {
    Scalar value;
    bool above;
  };
  struct BigTile {
    Index3 origin;  ///< in nodes
    std::int32_t size;
    std::uint32_t constant;
  };

  std::uint32_t node_at(const Index3& key);
  [[nodiscard]] const Node* find(const Index3& key) const;
  [[nodiscard]] std::optional<std::uint32_t> big_tile_at(const Index3& key) const {
    const std::optional<std::size_t> n = big_tile_number(key);
    return n ? std::optional(big_tiles_[*n].constant) : std::nullopt;
  }
  std::uint32_t constant_of(const Scalar& value, const Threshold& threshold);
  void add_leaves(std::span<const Index3> origins);
  void add_tiles(std::span<const Tile> tiles, const Threshold& threshold);
  void add_tile(const Tile& tile, std::uint32_t constant);
  void number_tiles(std::span<const Tile> tiles);
  void grow();
  struct Sides {
    Mask512 mixed, odd, even;
  };
  [[nodiscard]] Sides sides_of(const Index3& key) const;
  [[nodiscard]] std::vector<Index3> candidate_nodes() const;
  /// The candidates of one node, and which of each one's upper neighbours are above.
  struct NodeCandidates {
    Index3 key;
    Mask512 blocks, mixed;
    std::array<Mask512, 8> above;
  };
  [[nodiscard]] NodeCandidates candidates_in(const Index3& key) const;

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> slots_;  ///< open addressing: node number + 1, 0 where free
  std::uint32_t last_ = 0;            ///< node that was asked for last
  std::vector<std::uint32_t> leaf_entries_;
  std::vector<std::uint32_t> tile_entries_;
  std::vector<Constant> constants_;      ///< of tiles
  std::vector<BigTile> big_tiles_;       ///< ordered by origin
  std::vector<std::int32_t> big_sizes_;  ///< each size that occurs
  Constant background_{};
};

}  // namespace mc::extraction
