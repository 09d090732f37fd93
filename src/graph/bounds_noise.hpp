// SPDX-License-Identifier: MIT
#pragma once

#include "graph/bounds.hpp"

namespace mc::graph {

/// As bounds_of(), of noises of all kinds.
/// Cost     of a noise that varies little over the box, up to 32 of its samples.
Interval noise_bounds(const Instruction& instruction, const Interval (&at)[3]);

}  // namespace mc::graph
