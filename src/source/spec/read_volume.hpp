// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "mc/field.hpp"
#include "mc/graph.hpp"

namespace mc::source {

/// All samples of a volume, rounded to float32; of a sparse one those of its active box, and its
/// background beyond. `place` is how messages name it.
/// Errors   input: unreadable, a map to the world that cannot be inverted.
/// Threads  uses the caller's arena.
SampledVolume read_volume(const VolumeReader& reader, const std::string& place);

}  // namespace mc::source
