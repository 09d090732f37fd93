// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "source/spec/node_numbers.hpp"
#include "source/spec/nodes.hpp"
#include "source/spec/placing.hpp"

// The keys of transforms. A document says where a thing goes; a node holds the way back.

namespace mc::source {

namespace {

constexpr Matrix3 kIdentity{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

Vec3 read_axis(const JsonDocument& document, ObjectReader& keys) {
  const JsonValue* at = keys.value().find("axis");
  if (at == nullptr || at->kind != JsonKind::array) {
    return kIdentity[keys.choice("axis", 1, {"x", "y", "z"})];
  }
  const Vec3 axis = keys.numbers<3>("axis", std::nullopt, kAnyFloat);
  const double length = std::sqrt((axis[0] * axis[0] + axis[1] * axis[1]) + axis[2] * axis[2]);
  if (!(length > 0)) {
    document.fault(*at, "has no direction: expected a length above 0");
    return kIdentity[1];
  }
  return {axis[0] / length, axis[1] / length, axis[2] / length};
}

/// One angle about "axis", or three: about x, then y, then z.
Matrix3 read_rotation(const JsonDocument& document, ObjectReader& keys) {
  const JsonValue* at = keys.value().find("degrees");
  if (at == nullptr || at->kind != JsonKind::array) {
    const double degrees = keys.number("degrees", std::nullopt, kAnyFloat);
    return rotation_about(read_axis(document, keys), degrees);
  }
  const Vec3 degrees = keys.numbers<3>("degrees", std::nullopt, kAnyFloat);
  if (const JsonValue* axis = keys.optional("axis")) {
    document.fault(*axis, "is of no use beside three \"degrees\": expected no axis, or one angle");
  }
  Matrix3 turned = kIdentity;
  for (std::size_t n = 0; n < 3; ++n) {
    turned = product(rotation_about(kIdentity[n], degrees[n]), turned);
  }
  return turned;
}

Vec3 read_center(ObjectReader& keys) { return keys.numbers<3>("center", Vec3{0, 0, 0}, kAnyFloat); }

void fill_scale(const JsonDocument& document, Node& node, ObjectReader& keys) {
  const Vec3 factor = keys.numbers<3>("factor", std::nullopt, kAnyFloat, true);
  Matrix3 inverse{};
  double least = 3.4028234663852886e38;
  for (std::size_t n = 0; n < 3; ++n) {
    inverse[n][n] = 1 / factor[n];
    least = std::min(least, std::abs(factor[n]));
  }
  const JsonValue* at = keys.value().find("factor");
  if (at != nullptr && !(least >= kPositiveFloat.lo)) {
    document.fault(*at, "has a zero: expected numbers other than 0 (1.2e-38 to 3.4e38, float32)");
    return;
  }
  const Vec3 center = read_center(keys);
  node.list = placed(inverse, center, center);
  if (keys.choice("values", 0, {"keep", "scale"}) == 1) {
    put(node, 0, least);
  }
}

void fill_affine(const JsonDocument& document, Node& node, ObjectReader& keys) {
  const auto m = keys.numbers<12>("matrix", std::nullopt, kAnyFloat);
  const JsonValue* at = keys.value().find("matrix");
  const auto inverse =
      inverse_of({Vec3{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}});
  if (inverse) {
    node.list = placed(*inverse, {m[3], m[7], m[11]}, {0, 0, 0});
  }
  const auto finite = [](float v) { return std::isfinite(v); };
  const bool good = inverse && std::all_of(node.list.begin(), node.list.end(), finite);
  if (at != nullptr && at->items.size() == 12 && !good) {
    document.fault(*at, "cannot be inverted: expected a matrix that keeps all three dimensions");
  }
}

}  // namespace

void NodeLoader::fill_transform(Node& node, ObjectReader& keys, const std::string& name) {
  take_input(node, keys, "source");
  if (name == "translate") {
    node.list = placed(kIdentity, keys.numbers<3>("by", std::nullopt, kAnyFloat), {0, 0, 0});
  } else if (name == "rotate") {
    const Matrix3 turned = read_rotation(document_, keys);
    const Vec3 center = read_center(keys);
    node.list = placed(transposed(turned), center, center);
  } else if (name == "scale") {
    fill_scale(document_, node, keys);
  } else if (name == "affine") {
    fill_affine(document_, node, keys);
  } else if (name == "mirror") {
    node.axis = static_cast<std::uint8_t>(keys.choice("axis", std::nullopt, {"x", "y", "z"}));
    put(node, 0, keys.number("at", 0, kAnyFloat));
    put(node, 1, keys.choice("keep", 0, {"above", "below"}) == 0 ? 1 : -1);
  } else {
    fill_repeat(node, keys);
  }
}

void NodeLoader::fill_repeat(Node& node, ObjectReader& keys) {
  constexpr NumberRange kCopies{0, 16777216, false, "an integer from 0 to 16777216"};
  const Vec3 period = keys.numbers<3>("period", std::nullopt, kFloatNotNegative, true);
  const Vec3 copies = keys.numbers<3>("copies", Vec3{0, 0, 0}, kCopies, true);
  put3(node, 0, period);
  put3(node, 3, copies);
  const auto whole = [](double v) { return std::floor(v) == v; };
  if (!std::all_of(copies.begin(), copies.end(), whole)) {
    document_.fault(*keys.value().find("copies"),
                    std::string("has a fraction: expected ") + kCopies.text);
  }
  const JsonValue* at = keys.value().find("period");
  if (at != nullptr && period == Vec3{0, 0, 0}) {
    document_.fault(*at, "is 0 along all axes: expected one above 0");
  }
}

}  // namespace mc::source
