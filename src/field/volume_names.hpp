// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

#include "mc/field.hpp"

// How volume formats that have room for it spell what a volume says of itself.

namespace mc::field {

/// "level_set", "fog", "mask", "density_spec", "sdf_spec"; empty where unknown.
[[nodiscard]] const char* class_name(VolumeClass cls);
[[nodiscard]] std::optional<VolumeClass> class_named(std::string_view name);
/// "open", "closed", "solid".
[[nodiscard]] const char* border_name(Border border);
[[nodiscard]] std::optional<Border> border_named(std::string_view name);

}  // namespace mc::field
