// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "mc/field.hpp"
#include "mc/source.hpp"
#include "source/stream/input_file.hpp"

// NRRD volumes with raw or gzipped samples, attached (.nrrd) or detached (.nhdr).

namespace mc::source {

/// `header` is the file that begins with "NRRD"; data files are found relative to its folder.
/// Errors   input: damaged, cut off, or of a kind this version does not read; usage: raw's options.
VolumeReader open_nrrd(InputFile header, const SourceOptions& options, Progress& progress);

}  // namespace mc::source
