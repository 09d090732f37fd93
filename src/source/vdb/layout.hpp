// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "source/vdb/cursor.hpp"

// The outline of a VDB file: header, grid descriptors, metadata.

namespace mc::source {

/// Name -> type and bytes.
struct VdbMeta {
  std::string type;
  std::span<const std::byte> bytes;
};
using VdbMetaMap = std::map<std::string, VdbMeta, std::less<>>;
VdbMetaMap read_meta_map(VdbCursor& cursor);

/// One grid as its descriptor has it.
struct VdbGrid {
  std::string unique_name;  ///< with 0x1E and a number where several grids share a name
  std::string name;
  bool shares_name = false;  ///< with another grid of the file
  std::string number;        ///< that tells it from those; empty where there is none
  std::string tree_type;     ///< "Tree_float_5_4_3", without the suffix for half
  bool as_half = false;
  std::string instance_of;  ///< unique name of the grid whose tree this one shares
  std::size_t begin = 0;    ///< offset of its compression flags
  std::size_t end = 0;      ///< 0: unknown (a file that was written to a stream)
  std::size_t body = 0;     ///< offset of its transform
  std::uint32_t compression = 0;
  VdbMetaMap meta;

  /// "density[0]" where several share the name, else "density".
  [[nodiscard]] std::string shown_name() const;
  /// The same with the number wherever the file has one: OpenVDB numbers nameless grids always.
  [[nodiscard]] std::string numbered_name() const;
  /// "float", "vec3s", "ptdataidx32"; the whole of tree_type where it is not 5-4-3.
  [[nodiscard]] std::string type_name() const;
  [[nodiscard]] bool standard_tree() const;
  [[nodiscard]] std::string meta_text(std::string_view key) const;
  [[nodiscard]] std::optional<std::int32_t> meta_int32(std::string_view key) const;
  [[nodiscard]] std::optional<std::int64_t> meta_int64(std::string_view key) const;
  [[nodiscard]] std::optional<double> meta_double(std::string_view key) const;
  [[nodiscard]] std::optional<std::array<std::int32_t, 3>> meta_vec3i(std::string_view key) const;
};

/// Sets shares_name and number of all grids of a file. Grids of one name go by the metadata "index"
/// that Houdini gives each (its primitive's number) where all of them have a different one, else by
/// the number that OpenVDB added to the name: the two may disagree.
void number_grids(std::vector<VdbGrid>& grids);

struct VdbLayout {
  std::uint32_t file_version = 0;
  std::uint32_t library_major = 0, library_minor = 0;
  bool has_offsets = false;
  std::uint32_t n_grids = 0;
  std::size_t first_descriptor = 0;
};

/// Whether `head` begins with the magic of a VDB file.
[[nodiscard]] bool looks_like_vdb(std::string_view head);

/// Errors   input, named by `place`: no VDB file, a version before 222 or after 224, cut off.
VdbLayout read_vdb_layout(std::span<const std::byte> file, std::string_view place);

/// Reads the descriptor at `at`, and the grid's flags and metadata (which follow it at once where
/// the file has no offsets). Errors   input: cut off, offsets that go back or past the end.
VdbGrid read_vdb_grid(std::span<const std::byte> file, const VdbLayout& layout, std::size_t at,
                      std::string_view place);

}  // namespace mc::source
