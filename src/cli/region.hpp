// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "mc/field.hpp"

namespace mc::cli {

/// Refuses a region that the volume does not have. A dense volume ends at its box; a sparse one
/// goes on as background, so that a region may reach past its active samples, but not miss them
/// all. Errors   usage.
void check_region(const VolumeReader& reader, const std::optional<IndexBox>& region);

}  // namespace mc::cli
