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

/// The two axes of flat dims; those of xyz are all three.
inline constexpr std::array<std::array<std::uint8_t, 2>, 4> kDimsAxes{
    {{0, 1}, {0, 1}, {0, 2}, {1, 2}}};

/// Emits one graph. Its families of nodes are in emit_noise.cpp and emit_shape.cpp.
class Emitter {
 public:
  explicit Emitter(const Graph& graph) : graph_(graph) {
    world_.at = {push(Op::x, {}), push(Op::y, {}), push(Op::z, {})};
  }

  Value emit_root(NodeId root) { return emit(root, world_); }
  std::vector<Instruction> take() { return std::move(code_); }
  std::vector<std::shared_ptr<const DataUse>> take_data() { return data_.take(); }

 private:
  /// The value of an instruction: a new one, or that of an equal instruction before it.
  Value push(Op op, std::initializer_list<Value> inputs, const std::array<float, 6>& p = {},
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

  [[noreturn]] static void refuse() {
    throw Error(ErrorKind::usage, "",
                "fractals and warps expand to more than " +
                    std::to_string(Graph::kMaxInstructions) + " operations a sample",
                "nest fewer of them, or lower the octaves");
  }

  Value emit(NodeId id, const Domain& domain) {
    if (done_.size() > 4 * Graph::kMaxInstructions) {
      refuse();  // nodes that pass their input on cost no instruction, but memory here
    }
    const auto key = std::pair(id, domain);
    if (const auto known = done_.find(key); known != done_.end()) {
      return known->second;
    }
    const Value value = emit_new(graph_.node(id), domain);
    done_.emplace(key, value);
    return value;
  }

  Value emit_new(const Node& node, const Domain& domain);
  Value emit_arithmetic(const Node& node, const Domain& domain);
  Value emit_generator(const Node& node, const Domain& domain);
  Value emit_unity(const Node& node, const Domain& domain);
  Value emit_octave(const Node& node, const Domain& domain);
  Value emit_fractal(const Node& node, const Domain& domain);
  Value emit_weighted_fractal(const Node& node, const Domain& domain);
  std::array<Value, 3> emit_shifts(const Node& node, const Domain& domain, std::uint32_t octave,
                                   const Domain& at);
  Domain emit_warped(const Node& node, const Domain& domain);
  Value emit_warp(const Node& node, const Domain& domain);
  Value emit_select(const Node& node, const Domain& domain);
  Value emit_curve(const Node& node, const Domain& domain);
  Value emit_transform(const Node& node, const Domain& domain);
  Value emit_solid(const Node& node, const Domain& domain);
  Value emit_shell(const Node& node, const Domain& domain);
  Value emit_combination(const Node& node, const Domain& domain);
  Value emit_heightmap(const Node& node, const Domain& domain);
  Value emit_volume(const Node& node, const Domain& domain);

  Value unary(Op op, const Node& node, const Domain& domain, const std::array<float, 6>& p = {}) {
    return push(op, {emit(node.inputs[0], domain)}, p);
  }
  Value binary(Op op, const Node& node, const Domain& domain) {
    const Value a = emit(node.inputs[0], domain);
    return push(op, {a, emit(node.inputs[1], domain)});
  }
  /// Left to right.
  Value fold(Op op, const Node& node, const Domain& domain, const std::array<float, 6>& p = {}) {
    Value sum = emit(node.inputs[0], domain);
    for (std::size_t n = 1; n < node.inputs.size(); ++n) {
      sum = push(op, {sum, emit(node.inputs[n], domain)}, p);
    }
    return sum;
  }
  [[nodiscard]] bool density() const { return graph_.settings().convention == Convention::density; }
  Value linear(const Domain& domain, const float* row);
  std::array<Value, 3> moved(const Domain& domain, const std::vector<float>& matrix);
  Domain octave_of(const Node& node, const Domain& domain, std::uint32_t octave,
                   const Domain& previous);

  const Graph& graph_;
  std::vector<Instruction> code_;
  DataUses data_;
  std::map<std::pair<NodeId, Domain>, Value> done_;
  std::map<Recipe, Value> values_;
  Domain world_;
};

}  // namespace mc::graph
