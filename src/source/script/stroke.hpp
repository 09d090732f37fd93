// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "mc/edit.hpp"
#include "source/script/context.hpp"

// Where a brush goes: its path, its copies by symmetry, and how many positions that makes.

namespace mc::source {

[[nodiscard]] std::optional<BrushPath> read_path(const JsonDocument& document,
                                                 const JsonValue& value);
/// "x", "xz", or an object with "axes" and "at".
[[nodiscard]] std::optional<Mirror> read_mirror(const JsonDocument& document,
                                                const JsonValue& value);
[[nodiscard]] std::optional<Radial> read_radial(const JsonDocument& document,
                                                const JsonValue& value);

/// The radius that a path's spacing refers to, or less: the shape's inradius; 0 where it has none.
[[nodiscard]] double path_radius(const BrushShape& shape);
/// At least as many brush positions as the edit has; infinite past all bounds.
[[nodiscard]] double most_dabs(const Edit& edit);

}  // namespace mc::source
