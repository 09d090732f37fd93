// SPDX-License-Identifier: MIT
#include "source/script/context.hpp"

#include "source/spec/nodes.hpp"

// Nodes in scripts: solids are distances, positive inside, and iso is 0.

namespace mc::source {

std::shared_ptr<const GraphField> read_node(const JsonDocument& document, ScriptContext& context,
                                            const JsonValue& value) {
  const GraphSettings settings{.seed = context.seed};
  NodeLoader nodes(document, context.nodes, settings, context.files);
  const NodeId top = nodes.load(value);
  if (!document.faults.empty()) return nullptr;
  try {
    return std::make_shared<const GraphField>(nodes.graph().compile(top));
  } catch (const Error& error) {
    document.fault(value, error.what());
    return nullptr;
  }
}

}  // namespace mc::source
