// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "mc/field.hpp"
#include "source/vdb/layout.hpp"

// Which grid of a VDB file is meant, and whether it can be meshed.

namespace mc::source {

/// How samples of the grid are handed out; bool and mask become u8. nullopt: not scalar.
[[nodiscard]] std::optional<SampleType> scalar_type(const VdbGrid& grid);

/// Why the grid cannot be meshed, as far as its descriptor tells; empty if it can.
[[nodiscard]] std::string refusal(const VdbGrid& grid);

[[nodiscard]] VolumeClass volume_class(const VdbGrid& grid);

/// The grid that `wanted` names: with its number ("density[1]"), by its plain name (the first of
/// that name), or "#n" by position. Without `wanted` the first scalar grid. Errors   input: no grid
/// of that name, none at all, none that can be meshed.
[[nodiscard]] std::size_t choose_grid(std::span<const VdbGrid> grids,
                                      const std::optional<std::string>& wanted,
                                      std::string_view place);

}  // namespace mc::source
