// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "graph/program.hpp"

namespace mc::graph {

/// Makes a program of instructions in any order that puts inputs first: drops those that `result`
/// does not need, moves those that do not change along y to the front, and gives values registers,
/// which are used again after the last use.
[[nodiscard]] Program schedule(const std::vector<Instruction>& code, Value result);

}  // namespace mc::graph
