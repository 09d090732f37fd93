// SPDX-License-Identifier: MIT
#pragma once

#include "graph/program.hpp"
#include "mc/graph.hpp"

namespace mc::graph {

/// Turns the field `root` into instructions. Errors: usage, past Graph::kMaxInstructions.
[[nodiscard]] Program compile(const Graph& graph, NodeId root);

}  // namespace mc::graph
