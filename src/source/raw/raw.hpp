// SPDX-License-Identifier: MIT
#pragma once

#include "mc/source.hpp"

// Raw samples without a header: one file with all planes, or a series with one plane a file.

namespace mc::source {

/// Errors   usage: dims or type missing, dims out of range; input: a size that does not match.
Source open_raw(SourceInput& input, const SourceOptions& options, Progress& progress);

inline constexpr SourceFormat kRawFormat{
    .name = "raw",
    .display = "raw data",
    .extensions = "raw",
    .takes = {.dims = true, .type = true, .endian = true, .skip = true},
    .headerless = true,
    .sidecar = "nhdr",
    .several_files = true,
    .streams = true,
    .open = open_raw};

}  // namespace mc::source
