// SPDX-License-Identifier: MIT
#include "mc/graph.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "base/checked.hpp"
#include "graph/compile.hpp"
#include "graph/program.hpp"

// The graph under construction: what may be added, and how deep it is.

namespace mc {

namespace {

struct Arity {
  std::size_t least;
  std::size_t most;
};

Arity arity_of(NodeType type) {
  constexpr std::size_t kMany = Graph::kMaxNodes;
  switch (type) {
    case NodeType::constant:
    case NodeType::x:
    case NodeType::y:
    case NodeType::z:
    case NodeType::white:
    case NodeType::value:
    case NodeType::value_cubic:
    case NodeType::perlin:
    case NodeType::simplex:
    case NodeType::opensimplex2:
    case NodeType::cellular:
    case NodeType::sphere:
    case NodeType::box:
    case NodeType::plane:
    case NodeType::torus:
    case NodeType::roundbox:
    case NodeType::capsule:
    case NodeType::cylinder:
    case NodeType::cone:
    case NodeType::ellipsoid:
    case NodeType::gyroid:
    case NodeType::heightmap:
    case NodeType::volume:
      return {0, 0};
    case NodeType::unity_perlin2d:
      return {0, 2};
    case NodeType::add:
    case NodeType::mul:
    case NodeType::min:
    case NodeType::max:
    case NodeType::unite:
    case NodeType::intersect:
      return {1, kMany};
    case NodeType::sub:
    case NodeType::div:
    case NodeType::pow:
    case NodeType::mod:
    case NodeType::warp:
    case NodeType::difference:
      return {2, 2};
    case NodeType::mix:
    case NodeType::select:
      return {3, 3};
    default:
      return {1, 1};
  }
}

/// Whether the list has the size and order that the type wants.
bool is_good_list(const Node& node) {
  const std::vector<float>& list = node.list;
  const std::size_t n = list.size();
  switch (node.type) {
    case NodeType::affine:
      return n == 12;
    case NodeType::roundbox:
      return n == 1;
    case NodeType::capsule:
      return n == 8;
    case NodeType::terrace:
      return n == 0 || (n >= 2 && std::adjacent_find(list.begin(), list.end(),
                                                     std::greater_equal<>()) == list.end());
    case NodeType::curve:
      for (std::size_t at = 2; at < n; at += 2) {
        if (!(list[at - 2] < list[at])) {
          return false;
        }
      }
      return n >= 4 && n % 2 == 0;
    default:
      return n == 0;
  }
}

[[noreturn]] void refuse(const std::string& fault) { throw Error(ErrorKind::usage, "", fault); }

/// Counts are small enough for float32 to hold every pixel's place.
void check_raster(const Node& node) {
  constexpr std::int32_t kMostPixels = 1 << 22;
  if (node.raster == nullptr) {
    refuse("a node has no samples to read");
  }
  const Raster& raster = *node.raster;
  const auto counted = [](std::int32_t n) { return n >= 1 && n <= kMostPixels; };
  if (!counted(raster.width) || !counted(raster.height) ||
      raster.samples.size() !=
          static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height)) {
    refuse("a picture of " + std::to_string(raster.width) + "x" + std::to_string(raster.height) +
           " pixels: expected 1 to " + std::to_string(kMostPixels) + " along each axis");
  }
  if (!(node.numbers[2] > 0) || !(node.numbers[3] > 0)) {
    refuse("a picture's size is not above 0");
  }
}

void check_volume(const Node& node) {
  constexpr double kMostFactor = 1e100;  // times float32 and added up, still a double
  if (node.volume == nullptr) {
    refuse("a node has no samples to read");
  }
  const SampledVolume& volume = *node.volume;
  const auto n = [&](std::size_t axis) { return static_cast<std::uint64_t>(volume.dims[axis]); };
  const bool counted =
      std::all_of(volume.dims.begin(), volume.dims.end(), [](auto d) { return d >= 1; });
  if (!counted || base::checked_mul(n(0), n(1), n(2)) != volume.samples.size()) {
    refuse("a volume's dims are not those of its " + std::to_string(volume.samples.size()) +
           " samples");
  }
  const auto& m = volume.to_index.m;
  if (!std::all_of(m.begin(), m.end(), [](double v) { return std::abs(v) <= kMostFactor; })) {
    refuse("a volume's map has numbers past +-1e100");
  }
  if (node.filter == Filter::cubic || !std::isfinite(node.outside.value_or(0))) {
    refuse("a volume has the filters nearest and linear, and finite numbers outside");
  }
}

void check_node(const Node& node) {
  const Arity arity = arity_of(node.type);
  const std::size_t n = node.inputs.size();
  const bool odd_pair = node.type == NodeType::unity_perlin2d && n == 1;
  if (n < arity.least || n > arity.most || odd_pair) {
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
  if (!is_good_list(node)) {
    refuse("a node's list of " + std::to_string(node.list.size()) +
           " numbers is not what its type needs");
  }
  if (node.type == NodeType::heightmap) {
    check_raster(node);
  } else if (node.type == NodeType::volume) {
    check_volume(node);
  }
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
