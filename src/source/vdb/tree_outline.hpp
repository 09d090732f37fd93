// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "mc/field.hpp"
#include "source/vdb/cursor.hpp"
#include "source/vdb/layout.hpp"
#include "source/vdb/packed_values.hpp"

// Where everything of a 5-4-3 tree is in its file. Walking a tree reads its masks and lengths only,
// so that values can be unpacked later, in any order and on any thread, or not at all.

namespace mc::source {

/// What leaves of a tree hold.
enum class LeafKind : std::uint8_t { values, bits, mask };

struct TreeKind {
  LeafKind leaves = LeafKind::values;
  VdbStorage storage;
};

/// nullopt: a tree whose values are of no fixed size, like points. Precondition: 5-4-3 levels.
std::optional<TreeKind> tree_kind(const VdbGrid& grid);

struct TreeOutline {
  static constexpr std::int32_t kRootTileSize = 4096;                 ///< samples along an edge
  static constexpr std::size_t kMostChildren = std::size_t{1} << 15;  ///< of a node: 32x32x32

  struct RootTile {
    Index3 origin{};
    std::span<const std::byte> value;
    bool active = false;
  };
  /// An inner node; its values are those of the children that it does not have.
  struct Node {
    Index3 origin{};
    std::int32_t child_size = 0;  ///< samples along an edge: 128 or 8
    std::span<const std::byte> children;
    std::span<const std::byte> active;
    PackedValues values;

    [[nodiscard]] Index3 child_origin(std::size_t n) const;
  };
  struct Leaf {
    Index3 origin{};
    std::size_t at = 0;  ///< offset of what take_leaf() reads
    std::array<std::uint64_t, 8> active{};
  };

  std::span<const std::byte> background;
  std::vector<RootTile> root_tiles;
  std::vector<Node> nodes;
  std::vector<Leaf> leaves;  ///< in the order of the file
};

/// What stands in a file of one leaf.
struct LeafBuffer {
  std::span<const std::byte> active;  ///< a bit for each sample, as LeafReader orders them
  PackedValues values;                ///< of LeafKind::values
  std::span<const std::byte> bits;    ///< of the other kinds: set where the sample is true
};
LeafBuffer take_leaf(VdbCursor& cursor, const TreeKind& kind, std::string_view what);

/// Walks a tree and leaves the cursor behind it.
/// Errors   input: cut off, within `what`; nodes that overlap; limit: samples further than 2^30
/// from index 0, which leaves the engine no room to look at neighbours in 32 bits.
/// Cost     one cache line a node, and a page of the file at most.
TreeOutline walk_vdb_tree(VdbCursor& cursor, const TreeKind& kind, std::string_view what);

}  // namespace mc::source
