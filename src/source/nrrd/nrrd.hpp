// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "mc/source.hpp"

// NRRD volumes with raw or gzipped samples, attached (.nrrd) or detached (.nhdr).

namespace mc::source {

[[nodiscard]] Recognition recognise_nrrd(std::string_view head);

/// The input is the file that begins with "NRRD"; data files are found relative to its folder.
/// Errors   input: damaged, cut off, or of a kind this version does not read.
Source open_nrrd(SourceInput& input, const SourceOptions& options, Progress& progress);

inline constexpr SourceFormat kNrrdFormat{.name = "nrrd",
                                          .display = "NRRD",
                                          .extensions = "nrrd nhdr",
                                          .recognise = recognise_nrrd,
                                          .streams = true,
                                          .open = open_nrrd};

}  // namespace mc::source
