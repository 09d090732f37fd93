// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "mc/field.hpp"
#include "mc/source.hpp"
#include "source/mapped_file.hpp"

// VDB files. Float, double, int32, int64, bool and mask grids become LeafReaders; trees are never
// densified. Everything else is refused by name.

namespace mc::source {

struct VdbSource {
  std::unique_ptr<LeafReader> reader;
  std::vector<std::string> other_grids;  ///< scalar grids that were not chosen
};

/// Loads one grid: `options.grid`, else the first scalar one; its values, where they are too many
/// for `options.memory_bytes`, by and by.
/// Errors   input: damaged, no such grid, nothing scalar, a frustum, an empty grid; limit: memory.
VdbSource open_vdb(MappedFile file, const SourceOptions& options);

/// Lists all grids in file order. Trees are read only where the file does not say their extent.
std::vector<GridDescription> describe_vdb(MappedFile file);

}  // namespace mc::source
