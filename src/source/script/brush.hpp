// SPDX-License-Identifier: MIT
#pragma once

#include "mc/edit.hpp"
#include "source/script/context.hpp"

// The brush of a record: its shape and its falloff. What is at fault is noted, and something
// harmless returned.

namespace mc::source {

/// `on_path`: the brush follows a path, so that a capsule has no ends of its own.
[[nodiscard]] BrushShape read_shape(const JsonDocument& document, ScriptContext& context,
                                    const JsonValue& value, bool on_path);
/// An object, or the name of one that needs no more.
[[nodiscard]] Falloff read_falloff(const JsonDocument& document, const JsonValue& value);

/// A direction, one unit long.
[[nodiscard]] Vec3 read_direction(const JsonDocument& document, ObjectReader& keys,
                                  const char* key);
/// Degrees about x, then y, then z; nothing where the key is absent.
[[nodiscard]] Turn read_rotation(ObjectReader& keys, const char* key);

}  // namespace mc::source
