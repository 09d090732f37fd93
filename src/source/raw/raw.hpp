// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "mc/field.hpp"
#include "mc/source.hpp"
#include "source/input_files.hpp"

// Raw samples without a header: one file with all planes, or a series with one plane a file.

namespace mc::source {

/// Errors   usage: dims or type missing, dims out of range; input: a size that does not match.
VolumeReader open_raw(const InputFiles& inputs, const SourceOptions& options, Progress& progress);

}  // namespace mc::source
