// SPDX-License-Identifier: MIT
#include "mc/graph.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "graph/compile.hpp"
#include "graph/node_types.hpp"
#include "graph/program.hpp"

// The graph under construction: what may be added, and how deep it is.

namespace mc {

namespace {

/// How many inputs a node may have, by its type's keys.
bool takes_inputs(const graph::NodeRow& row, std::size_t n) {
  std::size_t n_nodes = 0;
  std::size_t n_paired = 0;
  for (const graph::NodeKey& key : row.keys) {
    if (key.kind == graph::KeyKind::inputs) return n >= 1 && n <= Graph::kMaxNodes;
    n_nodes += key.kind == graph::KeyKind::node ? 1 : 0;
    n_paired += key.kind == graph::KeyKind::paired ? 1 : 0;
  }
  return n == n_nodes || n == n_nodes + n_paired;
}

[[noreturn]] void refuse(const std::string& fault) { throw Error(ErrorKind::usage, "", fault); }

void check_node(const Node& node) {
  const graph::NodeRow& row = graph::row_of(node.type);
  const std::size_t n = node.inputs.size();
  if (!takes_inputs(row, n)) {
    refuse("a node has " + std::to_string(n) + " inputs: expected another number of them");
  }
  if (node.octaves < 1 || node.octaves > 32) {
    refuse("octaves is " + std::to_string(node.octaves) + ": expected 1 to 32");
  }
  if (node.axis > 2) {
    refuse("axis is " + std::to_string(node.axis) + ": expected 0, 1 or 2");
  }
  const auto finite = [](float v) { return std::isfinite(v); };
  if (!std::all_of(node.numbers.begin(), node.numbers.end(), finite) ||
      !std::all_of(node.list.begin(), node.list.end(), finite)) {
    refuse("a node's number is not finite");
  }
  if (row.takes_list == nullptr ? !node.list.empty() : !row.takes_list(node.list)) {
    refuse("a node's list of " + std::to_string(node.list.size()) +
           " numbers is not what its type needs");
  }
  if (row.check_samples != nullptr) row.check_samples(node);
}

}  // namespace

NodeId Graph::add(Node node) {
  check_node(node);
  if (nodes_.size() >= kMaxNodes) {
    refuse("more than " + std::to_string(kMaxNodes) + " nodes");
  }
  std::uint32_t deepest = 0;
  for (const NodeId input : node.inputs) {
    if (static_cast<std::size_t>(input) >= nodes_.size()) {
      refuse("a node's input is not in the graph: expected one that was added before it");
    }
    deepest = std::max(deepest, depth(input));
  }
  if (deepest >= kMaxDepth) {
    refuse("nodes nest deeper than " + std::to_string(kMaxDepth) + " levels");
  }
  nodes_.push_back(std::move(node));
  depths_.push_back(deepest + 1);
  return NodeId{static_cast<std::uint32_t>(nodes_.size() - 1)};
}

const Node& Graph::node(NodeId id) const {
  assert(static_cast<std::size_t>(id) < nodes_.size());
  return nodes_[static_cast<std::size_t>(id)];
}

std::uint32_t Graph::depth(NodeId id) const {
  assert(static_cast<std::size_t>(id) < depths_.size());
  return depths_[static_cast<std::size_t>(id)];
}

GraphField Graph::compile(NodeId root) const {
  return GraphField(std::make_unique<const graph::Program>(graph::compile(*this, root)));
}

}  // namespace mc
