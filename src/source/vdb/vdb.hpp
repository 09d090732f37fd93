// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "mc/source.hpp"

// VDB files. Float, double, int32, int64, bool and mask grids become LeafReaders; trees are never
// densified. Everything else is refused by name.

namespace mc::source {

[[nodiscard]] Recognition recognise_vdb(std::string_view head);

/// Loads one grid: `options.grid`, else the first scalar one. Values that are more than half of
/// `options.memory_bytes` are unpacked on demand.
/// Errors   input: damaged, no such grid, nothing scalar, a frustum, an empty grid; limit: memory.
Source open_vdb(SourceInput& input, const SourceOptions& options, Progress& progress);

/// Lists all grids in file order. Trees are read only where the file does not say their extent.
std::vector<GridDescription> describe_vdb(SourceInput& input, Progress& progress);

inline constexpr SourceFormat kVdbFormat{.name = "vdb",
                                         .display = "VDB",
                                         .extensions = "vdb",
                                         .package = "libopenvdb-dev",
                                         .built_in = MC_WITH_VDB != 0,
                                         .recognise = recognise_vdb,
                                         .takes = {.grid = true},
                                         .open = open_vdb,
                                         .describe = describe_vdb};

}  // namespace mc::source
