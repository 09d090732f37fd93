// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>

#include "source/spec/node_numbers.hpp"
#include "source/spec/nodes.hpp"

// The keys of solids, offset and shell.

namespace mc::source {

namespace {

void fill_plane(const JsonDocument& document, Node& node, ObjectReader& keys) {
  const Vec3 n = keys.numbers<3>("normal", Vec3{0, 1, 0}, kAnyFloat);
  const double length = std::sqrt((n[0] * n[0] + n[1] * n[1]) + n[2] * n[2]);
  put(node, 3, keys.number("offset", 0, kAnyFloat));
  if (!(length > 0)) {
    document.fault(*keys.value().find("normal"), "has no direction: expected a length above 0");
    return;
  }
  put3(node, 0, {n[0] / length, n[1] / length, n[2] / length});
}

void fill_roundbox(const JsonDocument& document, Node& node, ObjectReader& keys) {
  const Vec3 size = keys.numbers<3>("size", std::nullopt, kPositiveFloat, true);
  const double radius = keys.number("radius", std::nullopt, kPositiveFloat);
  put3(node, 3, size);
  node.list = {static_cast<float>(radius)};
  const JsonValue* at = keys.value().find("radius");
  if (at != nullptr && keys.value().find("size") != nullptr &&
      2 * radius > *std::min_element(size.begin(), size.end())) {
    document.fault(*at, as_found(*at) + ": expected at most half the least of \"size\"");
  }
}

void fill_capsule(Node& node, ObjectReader& keys) {
  const Vec3 from = keys.numbers<3>("from", std::nullopt, kAnyFloat);
  const Vec3 to = keys.numbers<3>("to", std::nullopt, kAnyFloat);
  const auto radius = keys.numbers<2>("radius", std::nullopt, kPositiveFloat, true);
  for (const double v : {from[0], from[1], from[2], to[0], to[1], to[2], radius[0], radius[1]}) {
    node.list.push_back(static_cast<float>(v));
  }
}

/// "radius" is that of the bottom, the top being a point, or both.
void fill_cone(const JsonDocument& document, Node& node, ObjectReader& keys) {
  const JsonValue* at = keys.value().find("radius");
  if (at != nullptr && at->kind == JsonKind::array) {
    const auto radii = keys.numbers<2>("radius", std::nullopt, kFloatNotNegative);
    put(node, 3, radii[0]);
    put(node, 4, radii[1]);
    if (radii[0] == 0 && radii[1] == 0) {
      document.fault(*at, "has two zeros: expected one number above 0");
    }
  } else {
    put(node, 3, keys.number("radius", std::nullopt, kPositiveFloat));
  }
  put(node, 5, keys.number("height", std::nullopt, kPositiveFloat));
}

}  // namespace

void NodeLoader::fill_solid(Node& node, ObjectReader& keys) {
  if (node.type == NodeType::plane) {
    return fill_plane(document_, node, keys);
  }
  if (node.type == NodeType::capsule) {
    return fill_capsule(node, keys);
  }
  put3(node, 0, keys.numbers<3>("center", Vec3{0, 0, 0}, kAnyFloat));
  switch (node.type) {
    case NodeType::box:
      return put3(node, 3, keys.numbers<3>("size", std::nullopt, kPositiveFloat, true));
    case NodeType::ellipsoid:
      return put3(node, 3, keys.numbers<3>("radii", std::nullopt, kPositiveFloat, true));
    case NodeType::roundbox:
      return fill_roundbox(document_, node, keys);
    case NodeType::gyroid:
      put(node, 3, keys.number("period", std::nullopt, kPositiveFloat));
      put(node, 4, keys.number("thickness", 0, kPositiveFloat));
      return;
    case NodeType::cone:
      fill_cone(document_, node, keys);
      break;
    default:
      put(node, 3, keys.number("radius", std::nullopt, kPositiveFloat));
  }
  if (node.type == NodeType::torus) {
    put(node, 4, keys.number("tube", std::nullopt, kPositiveFloat));
  } else if (node.type == NodeType::cylinder) {
    put(node, 4, keys.number("height", std::nullopt, kPositiveFloat));
  }
  if (node.type != NodeType::sphere) {
    node.axis = static_cast<std::uint8_t>(keys.choice("axis", 1, {"x", "y", "z"}));
  }
}

void NodeLoader::fill_shell(Node& node, ObjectReader& keys) {
  take_input(node, keys, "source");
  if (node.type == NodeType::offset) {
    return put(node, 0, keys.number("distance", std::nullopt, kAnyFloat));
  }
  constexpr std::array<double, 3> kDepth{0.5, 0, -0.5};
  const double thickness = keys.number("thickness", std::nullopt, kPositiveFloat);
  put(node, 0, thickness);
  put(node, 1, kDepth[keys.choice("side", 0, {"inside", "both", "outside"})] * thickness);
}

}  // namespace mc::source
