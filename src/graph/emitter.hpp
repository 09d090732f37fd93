// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "graph/data_uses.hpp"
#include "graph/node_types.hpp"
#include "graph/ops.hpp"
#include "graph/program.hpp"
#include "graph/reduce.hpp"
#include "mc/graph.hpp"

// From a graph to straight-line code. A node is emitted once for each domain (coordinates, seed
// salt, dims) it is asked for in: fbm and warp ask for their source in domains of their own, all
// other nodes pass theirs on. Equal instructions are made once, and those of constants not at all.

namespace mc::graph {

/// Where a node is evaluated.
struct Domain {
  std::array<Value, 3> at{};  ///< the coordinates x, y, z
  std::uint32_t salt = 0;     ///< changes the seeds below it; 0 leaves them
  std::optional<Dims> dims;   ///< of generators that do not say

  bool operator<(const Domain& other) const {
    return std::tie(at, salt, dims) < std::tie(other.at, other.salt, other.dims);
  }
};

/// Emits one graph. How each type of node does it is in nodes/.
class Emitter {
 public:
  explicit Emitter(const Graph& graph) : graph_(graph) {
    world_.at = {push(Op::x, {}), push(Op::y, {}), push(Op::z, {})};
  }

  Value emit_root(NodeId root) { return emit(root, world_); }
  std::vector<Instruction> take() { return std::move(code_); }
  std::vector<std::shared_ptr<const DataUse>> take_data() { return data_.take(); }

  /// The value of an instruction: a new one, or that of an equal instruction before it.
  Value push(Op op, std::initializer_list<Value> inputs, const Numbers& p = {},
             std::uint32_t seed = 0, const DataUse* data = nullptr) {
    assert(inputs.size() == row_of(op).n_inputs);
    Instruction instruction{.op = op,
                            .out = static_cast<Value>(code_.size()),
                            .n_in = static_cast<std::uint8_t>(inputs.size()),
                            .seed = seed,
                            .p = p,
                            .data = data};
    std::copy(inputs.begin(), inputs.end(), instruction.in.begin());
    instruction = reduced(instruction, code_);
    if (code_.size() >= Graph::kMaxInstructions) {
      refuse();
    }
    const auto [known, is_new] = values_.try_emplace(recipe_of(instruction), instruction.out);
    if (is_new) {
      code_.push_back(instruction);
    }
    return known->second;
  }

  /// The value of a node in a domain.
  Value emit(NodeId id, const Domain& domain) {
    if (done_.size() > 4 * Graph::kMaxInstructions) {
      refuse();  // nodes that pass their input on cost no instruction, but memory here
    }
    const auto key = std::pair(id, domain);
    if (const auto known = done_.find(key); known != done_.end()) {
      return known->second;
    }
    const Node& node = graph_.node(id);
    const Value value = row_of(node.type).emit(*this, node, domain);
    done_.emplace(key, value);
    return value;
  }

  /// An operation over all inputs of a node, from left to right.
  Value fold(Op op, const Node& node, const Domain& domain, const Numbers& p = {}) {
    Value sum = emit(node.inputs[0], domain);
    for (std::size_t n = 1; n < node.inputs.size(); ++n) {
      sum = push(op, {sum, emit(node.inputs[n], domain)}, p);
    }
    return sum;
  }

  /// How the node reads its samples.
  const DataUse* use_of(const Node& node) { return data_.of(node); }
  [[nodiscard]] const GraphSettings& settings() const { return graph_.settings(); }
  [[nodiscard]] bool density() const { return settings().convention == Convention::density; }

 private:
  [[noreturn]] static void refuse() {
    throw Error(ErrorKind::usage, "",
                "fractals and warps expand to more than " +
                    std::to_string(Graph::kMaxInstructions) + " operations a sample",
                "nest fewer of them, or lower the octaves");
  }

  const Graph& graph_;
  std::vector<Instruction> code_;
  DataUses data_;
  std::map<std::pair<NodeId, Domain>, Value> done_;
  std::map<Recipe, Value> values_;
  Domain world_;
};

}  // namespace mc::graph
