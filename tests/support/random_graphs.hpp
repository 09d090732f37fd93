// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "graph/node_types.hpp"
#include "mc/graph.hpp"

// Seeded random graphs that are valid: every type of node, inputs from all before it, numbers that
// make most fields finite and few of them dull.

namespace mc::test {

class RandomGraph {
 public:
  RandomGraph(std::uint32_t seed, Convention convention)
      : random_(seed), graph_({.seed = seed, .convention = convention, .iso = 0.25F}) {
    for (const NodeType type : {NodeType::x, NodeType::y, NodeType::z}) {
      ids_.push_back(graph_.add({.type = type}));
    }
  }

  /// Adds n nodes; the last one depends on many of them.
  NodeId grow(int n) {
    for (int i = 0; i < n; ++i) ids_.push_back(graph_.add(node()));
    return ids_.back();
  }
  [[nodiscard]] const Graph& graph() const { return graph_; }

 private:
  /// All types but those that read samples.
  static const std::vector<NodeType>& types() {
    static const std::vector<NodeType> kTypes = [] {
      std::vector<NodeType> all;
      for (const graph::NodeRow* row : graph::node_rows()) {
        const bool is_new = all.empty() || all.back() != row->type;
        if (row->check_samples == nullptr && is_new) all.push_back(row->type);
      }
      return all;
    }();
    return kTypes;
  }

  float real(float lo, float hi) { return std::uniform_real_distribution<float>(lo, hi)(random_); }
  int whole(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(random_); }

  /// Mostly a late node, so that graphs get deep.
  NodeId input() {
    const auto n = static_cast<int>(ids_.size());
    const int back = std::min(whole(0, n - 1), whole(0, n - 1));
    return ids_[static_cast<std::size_t>(n - 1 - back)];
  }
  std::vector<NodeId> inputs(int n) {
    std::vector<NodeId> out;
    for (int i = 0; i < n; ++i) out.push_back(input());
    return out;
  }

  std::vector<float> rising(int n) {
    std::vector<float> out{real(-3, 0)};
    while (static_cast<int>(out.size()) < n) out.push_back(out.back() + real(0.1F, 2));
    return out;
  }

  Node node() {
    Node out;
    out.type = types()[static_cast<std::size_t>(whole(0, static_cast<int>(types().size()) - 1))];
    for (float& number : out.numbers) number = real(-3, 3);
    out.seed = static_cast<std::uint32_t>(whole(0, 3));
    if (whole(0, 2) == 0) out.dims = static_cast<Dims>(whole(0, 3));
    complete(out);
    return out;
  }

  void complete(Node& out) {
    if (complete_combination(out) || complete_change(out) || complete_noise(out) ||
        complete_shape(out)) {
      return;
    }
    for (const graph::NodeKey& key : graph::row_of(out.type).keys) {
      if (key.kind == graph::KeyKind::node) {
        out.inputs.push_back(input());
      } else if (key.kind == graph::KeyKind::number && key.at >= 0) {
        float& number = out.numbers[static_cast<std::size_t>(key.at)];
        number = static_cast<float>(std::clamp(double{number}, key.range->lo, key.range->hi));
      }
    }
  }

  /// Of several fields.
  bool complete_combination(Node& out) {
    auto& p = out.numbers;
    switch (out.type) {
      case NodeType::add:
      case NodeType::mul:
      case NodeType::min:
      case NodeType::max:
        out.inputs = inputs(whole(1, 3));
        return true;
      case NodeType::unite:
      case NodeType::intersect:
        out.inputs = inputs(whole(1, 3));
        p[0] = whole(0, 1) == 0 ? 0 : std::abs(p[0]);
        return true;
      case NodeType::difference:
        out.inputs = inputs(2);
        p[0] = whole(0, 1) == 0 ? 0 : std::abs(p[0]);
        return true;
      case NodeType::sub:
      case NodeType::div:
      case NodeType::mod:
        out.inputs = inputs(2);
        return true;
      case NodeType::pow:
        out.inputs = {input(), graph_.add({.numbers = {static_cast<float>(whole(-2, 4)) * 0.5F}})};
        return true;
      case NodeType::mix:
        out.inputs = inputs(3);
        return true;
      case NodeType::select:
        out.inputs = inputs(3);
        p[1] = whole(0, 1) == 0 ? 0 : std::abs(p[1]);
        return true;
      default:
        return false;
    }
  }

  /// Of one field, its values or places.
  bool complete_change(Node& out) {
    auto& p = out.numbers;
    switch (out.type) {
      case NodeType::curve:
        out.inputs = inputs(1);
        out.curve_shape = static_cast<CurveShape>(whole(0, 2));
        for (const float x : rising(whole(2, 4))) out.list.insert(out.list.end(), {x, real(-3, 3)});
        return true;
      case NodeType::terrace:
        out.inputs = inputs(1);
        p = {std::abs(p[0]) + 0.1F, p[1], real(0, 1)};
        if (whole(0, 1) == 0) out.list = rising(whole(2, 4));
        return true;
      case NodeType::affine:
        out.inputs = inputs(1);
        p[0] = whole(0, 1) == 0 ? 0 : p[0];
        for (int n = 0; n < 12; ++n) out.list.push_back(whole(0, 2) == 0 ? 0 : real(-2, 2));
        return true;
      case NodeType::mirror:
        out.inputs = inputs(1);
        p[1] = whole(0, 1) == 0 ? -1 : 1;
        out.axis = static_cast<std::uint8_t>(whole(0, 2));
        return true;
      case NodeType::repeat:
        out.inputs = inputs(1);
        for (std::size_t n = 0; n < 3; ++n) {
          p[n] = std::max(p[n] + 1, 0.0F);
          p[n + 3] = static_cast<float>(whole(0, 3));
        }
        return true;
      case NodeType::clamp:
      case NodeType::smoothstep:
        out.inputs = inputs(1);
        p[1] = p[0] + std::abs(p[1]) + 0.1F;
        return true;
      case NodeType::remap:
        out.inputs = inputs(1);
        p[1] = p[0] + std::copysign(std::abs(p[1]) + 0.1F, p[1]);
        return true;
      default:
        return false;
    }
  }

  /// Noises and what is made of their octaves.
  bool complete_noise(Node& out) {
    auto& p = out.numbers;
    switch (out.type) {
      case NodeType::white:
      case NodeType::value:
      case NodeType::value_cubic:
      case NodeType::perlin:
      case NodeType::simplex:
      case NodeType::opensimplex2:
        p[0] = std::exp2(p[0] - 3);
        return true;
      case NodeType::cellular:
        p[0] = std::exp2(p[0] - 3);
        p[1] = std::abs(p[1]) / 3;
        out.cell_return = static_cast<CellReturn>(whole(0, 3));
        out.cell_metric = static_cast<CellMetric>(whole(0, 2));
        return true;
      case NodeType::unity_perlin2d:
        p[0] = std::exp2(p[0] - 3);
        if (whole(0, 1) == 0) out.inputs = inputs(2);
        return true;
      case NodeType::fbm:
      case NodeType::ridged:
      case NodeType::billow:
      case NodeType::pingpong:
        out.inputs = inputs(1);
        out.octaves = static_cast<std::uint32_t>(whole(1, 3));
        p = {2, 0.5F, whole(0, 1) == 0 ? 0 : std::abs(p[2]) / 3, std::abs(p[3])};
        return true;
      case NodeType::warp:
        out.inputs = inputs(2);
        out.warp_mode = static_cast<WarpMode>(whole(0, 2));
        out.octaves = static_cast<std::uint32_t>(whole(1, 3));
        return true;
      default:
        return false;
    }
  }

  /// Solids, and what has no input.
  bool complete_shape(Node& out) {
    auto& p = out.numbers;
    switch (out.type) {
      case NodeType::box:
        for (std::size_t n = 3; n < 6; ++n) p[n] = std::abs(p[n]) * 2;
        return true;
      case NodeType::torus:
        p[4] = std::abs(p[4]) / 3;
        p[3] = std::abs(p[3]);
        out.axis = static_cast<std::uint8_t>(whole(0, 2));
        return true;
      case NodeType::roundbox:
        for (std::size_t n = 3; n < 6; ++n) p[n] = 1 + std::abs(p[n]) * 2;
        out.list = {real(0, 0.5F)};
        return true;
      case NodeType::capsule:
        for (int n = 0; n < 6; ++n) out.list.push_back(real(-3, 3));
        for (int n = 0; n < 2; ++n) out.list.push_back(real(0.1F, 2));
        return true;
      case NodeType::cylinder:
      case NodeType::cone:
      case NodeType::ellipsoid:
        for (std::size_t n = 3; n < 6; ++n) p[n] = 0.1F + std::abs(p[n]);
        out.axis = static_cast<std::uint8_t>(whole(0, 2));
        return true;
      case NodeType::gyroid:
        p[3] = 0.5F + std::abs(p[3]);
        p[4] = whole(0, 1) == 0 ? 0 : std::abs(p[4]) / 6;
        return true;
      case NodeType::shell:
        out.inputs = inputs(1);
        p[0] = std::abs(p[0]);
        return true;
      case NodeType::sphere:
        p[3] = std::abs(p[3]);
        return true;
      case NodeType::constant:
      case NodeType::x:
      case NodeType::y:
      case NodeType::z:
      case NodeType::plane:
        return true;
      default:
        return false;
    }
  }

  std::mt19937 random_;
  Graph graph_;
  std::vector<NodeId> ids_;
};

}  // namespace mc::test
