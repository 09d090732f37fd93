// SPDX-License-Identifier: MIT
#include "graph/compile.hpp"

#include "graph/emitter.hpp"
#include "graph/schedule.hpp"

namespace mc::graph {

Program compile(const Graph& graph, NodeId root) {
  Emitter emitter(graph);
  const Value result = emitter.emit_root(root);
  Program program = schedule(emitter.take(), result);
  program.data = emitter.take_data();
  return program;
}

}  // namespace mc::graph
