// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "mc/field.hpp"
#include "source/mapped_file.hpp"
#include "source/vdb/tree_outline.hpp"

namespace mc::source {

/// Whether leaves are looked at, or only what can be told without: leaf_values() is then not to be
/// called.
enum class LeafValues : bool { read, left_packed };

/// Where a tree comes from.
struct TreeFile {
  std::shared_ptr<const MappedFile> file;  ///< what the outline points to
  TreeKind kind;
  std::string_view what;  ///< in messages: the grid

  [[nodiscard]] std::span<const std::byte> bytes() const { return file->bytes(); }
  [[nodiscard]] std::string_view place() const { return file->place(); }
};

/// A grid's tree as the port that the engine reads. Fills in the volume's box and n_active; where
/// nothing is active the box is that of all that is stored (inactive values count as values).
/// With its samples it may hold half of `memory_bytes`: else leaves stay in the file, which is kept
/// then, and are unpacked whenever they are asked for; an eighth is for those that were last.
/// Errors   input: what does not unpack, here or from leaf_values().
/// Threads  uses the caller's arena: leaves are unpacked on all of it.
/// Cost     the samples' memory, written once, or none; and 104 bytes a leaf.
std::unique_ptr<LeafReader> read_vdb_tree(const TreeFile& file, TreeOutline outline,
                                          const Volume& volume, LeafValues wanted,
                                          std::uint64_t memory_bytes);

}  // namespace mc::source
