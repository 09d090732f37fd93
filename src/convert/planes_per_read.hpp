// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string_view>

#include "mc/field.hpp"

namespace mc::conversion {

/// Planes to read at a time: many enough to share among threads, few enough for the budget, which
/// the reader's copy and the writer's share. Errors   limit, named by `place`: not even one.
std::int32_t planes_per_read(const Volume& volume, std::uint64_t memory_bytes,
                             std::string_view place);

}  // namespace mc::conversion
