// SPDX-License-Identifier: MIT
#pragma once

#include <memory>

#include "mc/field.hpp"
#include "mc/graph.hpp"

namespace mc::source {

/// An attribute that an mc-volume document gives to vertices: the value of `field` there, an f32;
/// or, for material_attribute(), the nearest index to it. The document's samples start at `origin`,
/// `spacing` apart.
[[nodiscard]] std::unique_ptr<AttributeReader> field_attribute(const AttributeInfo& info,
                                                               GraphField field, const Vec3& origin,
                                                               const Vec3& spacing);

}  // namespace mc::source
