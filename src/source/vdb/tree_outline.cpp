// SPDX-License-Identifier: MIT
#include "source/vdb/tree_outline.hpp"

#if MC_WITH_VDB

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <utility>

// Source   OpenVDB 10, readTopology() and readBuffers() of tree/RootNode.h, InternalNode.h,
// LeafNode.h, LeafNodeBool.h and LeafNodeMask.h. Differs: versions 222 and later only; a node that
// comes twice is refused.

namespace mc::source {

namespace {

constexpr std::int32_t kLeafSize = 8;
constexpr std::size_t kLeafMaskBytes = LeafReader::kLeafSamples / 8;

/// Sizes of the types that OpenVDB's library knows; a half is 2 bytes a component.
struct TypeSize {
  std::string_view name;
  std::size_t value_bytes;
  std::size_t half_bytes;  // as many as value_bytes where as_half means nothing
  LeafKind leaves = LeafKind::values;
};
constexpr std::array<TypeSize, 9> kTypeSizes{{
    {"float", 4, 2},
    {"double", 8, 2},
    {"int32", 4, 4},
    {"int64", 8, 8},
    {"bool", 1, 1, LeafKind::bits},
    {"mask", 1, 1, LeafKind::mask},
    {"vec3s", 12, 6},
    {"vec3d", 24, 6},
    {"vec3i", 12, 12},
}};

/// Root keys are stored as they are, and nodes below them rounded: only rounded keys keep nodes
/// apart.
void check_key(const Index3& key, std::string_view place) {
  constexpr std::int32_t kFarthest = 1 << 30;
  for (const std::int32_t n : key) {
    if (n % TreeOutline::kRootTileSize != 0) {
      damaged_vdb(place, "a node that no node fits beside");
    }
    if (n < -kFarthest || n > kFarthest - TreeOutline::kRootTileSize) {
      throw Error(ErrorKind::limit, place,
                  "samples lie further than 2^30 from index 0, beyond what can be meshed");
    }
  }
}

class TreeWalk {
 public:
  TreeWalk(VdbCursor& cursor, const TreeKind& kind, std::string_view what)
      : cursor_(cursor), kind_(kind), what_(what) {}

  TreeOutline run() {
    if (const auto n = cursor_.number<std::int32_t>(what_); n != 1) {
      throw Error(ErrorKind::input, cursor_.place(),
                  fmt::format("{}: a tree of {} buffers, but one was expected", what_, n));
    }
    walk_root();
    for (TreeOutline::Leaf& leaf : tree_.leaves) {
      walk_buffer(leaf);
    }
    return std::move(tree_);
  }

 private:
  Index3 key() {
    const auto key = cursor_.number<Index3>(what_);
    check_key(key, cursor_.place());
    keys_.push_back(key);
    return key;
  }

  void walk_root() {
    tree_.background = cursor_.take(kind_.storage.value_bytes, what_);
    const auto n_tiles = cursor_.number<std::uint32_t>(what_);
    const auto n_children = cursor_.number<std::uint32_t>(what_);
    for (std::uint32_t n = 0; n < n_tiles; ++n) {  // each takes bytes: the file bounds the loop
      const Index3 origin = key();
      const std::span<const std::byte> value = cursor_.take(kind_.storage.value_bytes, what_);
      tree_.root_tiles.push_back({origin, value, cursor_.number<std::uint8_t>(what_) != 0});
    }
    for (std::uint32_t n = 0; n < n_children; ++n) {
      walk_node<5>(key(), TreeOutline::kRootTileSize / 32);
    }
    std::ranges::sort(keys_);
    if (std::ranges::adjacent_find(keys_) != keys_.end()) {
      damaged_vdb(cursor_.place(), fmt::format("{}: the same node twice", what_));
    }
  }

  template <unsigned Log2>
  void walk_node(const Index3& origin, std::int32_t child_size) {
    constexpr std::size_t kMaskBytes = (std::size_t{1} << 3 * Log2) / 8;
    const std::span<const std::byte> children = cursor_.take(kMaskBytes, what_);
    const std::span<const std::byte> active = cursor_.take(kMaskBytes, what_);
    const TreeOutline::Node node{origin, child_size, children, active,
                                 take_values(cursor_, kind_.storage, active, what_)};
    tree_.nodes.push_back(node);
    for (std::size_t at = 0; at < kMaskBytes; at += sizeof(std::uint64_t)) {
      for (auto left = number_at<std::uint64_t>(children.data() + at); left != 0;
           left &= left - 1) {
        const auto n = at * 8 + static_cast<std::size_t>(std::countr_zero(left));
        const Index3 child = node.child_origin(n);
        if constexpr (Log2 == 5) {
          walk_node<4>(child, kLeafSize);
        } else {
          tree_.leaves.push_back({child, 0, {}});
          cursor_.take(kLeafMaskBytes, what_);
        }
      }
    }
  }

  /// The second part of the file: each leaf's mask once more, then its values.
  void walk_buffer(TreeOutline::Leaf& leaf) {
    leaf.at = cursor_.at();
    const std::span<const std::byte> active = take_leaf(cursor_, kind_, what_).active;
    std::memcpy(leaf.active.data(), active.data(), sizeof leaf.active);
  }

  VdbCursor& cursor_;
  const TreeKind& kind_;
  std::string_view what_;
  TreeOutline tree_;
  std::vector<Index3> keys_;
};

}  // namespace

Index3 TreeOutline::Node::child_origin(std::size_t n) const {
  const unsigned log2 = child_size == kLeafSize ? 4 : 5;
  const std::size_t mask = (std::size_t{1} << log2) - 1;
  const auto along = [&](std::size_t at) { return static_cast<std::int32_t>(at) * child_size; };
  return {origin[0] + along(n >> (2 * log2)), origin[1] + along(n >> log2 & mask),
          origin[2] + along(n & mask)};
}

std::optional<TreeKind> tree_kind(const VdbGrid& grid) {
  const std::string type = grid.type_name();
  const auto* row = std::ranges::find(kTypeSizes, type, &TypeSize::name);
  if (row == kTypeSizes.end() || !grid.standard_tree()) {
    return std::nullopt;
  }
  const std::size_t packed = grid.as_half ? row->half_bytes : row->value_bytes;
  return TreeKind{row->leaves, {row->value_bytes, packed, grid.compression}};
}

LeafBuffer take_leaf(VdbCursor& cursor, const TreeKind& kind, std::string_view what) {
  LeafBuffer leaf;
  leaf.active = cursor.take(kLeafMaskBytes, what);
  if (kind.leaves == LeafKind::values) {
    leaf.values = take_values(cursor, kind.storage, leaf.active, what);
    return leaf;
  }
  cursor.take(sizeof(Index3), what);  // its origin
  leaf.bits = kind.leaves == LeafKind::bits ? cursor.take(kLeafMaskBytes, what) : leaf.active;
  return leaf;
}

TreeOutline walk_vdb_tree(VdbCursor& cursor, const TreeKind& kind, std::string_view what) {
  return TreeWalk(cursor, kind, what).run();
}

}  // namespace mc::source

#endif
