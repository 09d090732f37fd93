// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "mc/field.hpp"

namespace mc::field {

/// The samples of `volume` as an attribute of the vertices of another: see mc::volume_attribute().
[[nodiscard]] std::unique_ptr<AttributeReader> volume_attribute(const VolumeReader& volume,
                                                                std::string name,
                                                                const Affine& to_world);

/// Bytes that the attribute of a volume holds, pages of mapped files aside.
[[nodiscard]] std::uint64_t volume_attribute_bytes(const VolumeReader& volume);

}  // namespace mc::field
