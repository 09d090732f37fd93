// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string_view>

#include "mc/field.hpp"
#include "source/vdb/cursor.hpp"

namespace mc::source {

/// Reads a grid's transform and leaves the cursor behind it. nullopt: a frustum, which is not
/// linear. Errors   input: cut off, within `what`; a kind of map that VDB does not have; one that
/// is projective.
std::optional<Affine> read_vdb_map(VdbCursor& cursor, std::string_view what);

}  // namespace mc::source
