// SPDX-License-Identifier: MIT
#pragma once

#include "mc/field.hpp"

// How volume formats that have room for it spell what a volume says of itself.

namespace mc::sink {

/// "level_set", "fog", "mask", "density_spec", "sdf_spec"; empty where unknown.
[[nodiscard]] const char* class_name(VolumeClass cls);
/// "open", "closed", "solid".
[[nodiscard]] const char* border_name(Border border);

}  // namespace mc::sink
