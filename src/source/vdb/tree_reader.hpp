// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "mc/field.hpp"
#include "source/vdb/tree_outline.hpp"

namespace mc::source {

/// Whether leaves are unpacked, or only what can be told without: leaf_values() is then not to be
/// called.
enum class LeafValues : bool { unpacked, left_packed };

/// Where a tree comes from.
struct TreeFile {
  std::span<const std::byte> bytes;  ///< what the outline points to
  TreeKind kind;
  std::string_view place;  ///< in messages
  std::string_view what;   ///< in messages: the grid
};

/// A grid's tree as the port that the engine reads; the file is not needed afterwards. Fills in the
/// volume's box and n_active; where nothing is active the box is that of all that is stored
/// (inactive values count as values).
/// Errors   input: what does not unpack.
/// Threads  uses the caller's arena: leaves are unpacked on all of it.
/// Cost     the samples' memory, written once, and 104 bytes a leaf.
std::unique_ptr<LeafReader> read_vdb_tree(const TreeFile& file, TreeOutline outline,
                                          const Volume& volume, LeafValues wanted);

}  // namespace mc::source
