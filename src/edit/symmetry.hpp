// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "mc/edit.hpp"

namespace mc::edit {

/// For each copy by symmetry the map back to the original, which comes first: for each turn, the
/// mirror images of bits 0 to 7 (x, y, z). Copies that coincide count once.
std::vector<Affine> copies(const Edit& edit);

}  // namespace mc::edit
