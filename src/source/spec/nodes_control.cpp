// SPDX-License-Identifier: MIT
#include <optional>

#include "source/spec/node_numbers.hpp"
#include "source/spec/nodes.hpp"

// The keys of the nodes that reshape or choose values: select, curve, terrace, floor-hard.

namespace mc::source {

namespace {

constexpr std::size_t kMostPoints = 256;

/// An array of 2 to kMostPoints items; null, and a fault, where it is not.
const JsonValue* as_points(const JsonDocument& document, const JsonValue* found, const char* what) {
  if (found == nullptr) {
    return nullptr;
  }
  const bool is_array = found->kind == JsonKind::array;
  if (!is_array || found->items.size() < 2 || found->items.size() > kMostPoints) {
    const std::string size = is_array ? " of " + std::to_string(found->items.size()) : "";
    document.fault(*found, as_found(*found) + size + ": expected an array of 2 to " +
                               std::to_string(kMostPoints) + " " + what);
    return nullptr;
  }
  return found;
}

/// The number, as float; none, and a fault, where it is no number that a float can hold.
std::optional<float> as_float(const JsonDocument& document, const JsonValue& item) {
  if (item.kind == JsonKind::number && item.number >= kAnyFloat.lo && item.number <= kAnyFloat.hi) {
    return static_cast<float>(item.number);
  }
  document.fault(item, as_found(item) + ": expected " + kAnyFloat.text);
  return std::nullopt;
}

/// Whether `next` comes after all `stride`-th numbers of the list; a fault where it does not.
bool rises(const JsonDocument& document, const JsonValue& item, const std::vector<float>& list,
           std::size_t stride, float next) {
  if (list.empty() || next > list[list.size() - stride]) {
    return true;
  }
  document.fault(item, "does not rise: expected more than in the one before (as float32)");
  return false;
}

}  // namespace

void NodeLoader::fill_control(Node& node, ObjectReader& keys) {
  if (node.type == NodeType::select) {
    take_input(node, keys, "a");
    take_input(node, keys, "b");
    take_input(node, keys, "control");
    put(node, 0, keys.number("threshold", 0, kAnyFloat));
    put(node, 1, keys.number("blend", 0, kFloatNotNegative));
    return;
  }
  take_input(node, keys, "source");
  if (node.type == NodeType::curve) {
    fill_points(node, keys);
  } else if (node.type == NodeType::terrace) {
    fill_steps(node, keys);
  } else {
    put(node, 0, keys.number("height", 0, kAnyFloat));
    put(node, 1, keys.number("weight", std::nullopt, kFloatNotNegative));
  }
}

void NodeLoader::fill_points(Node& node, ObjectReader& keys) {
  const JsonValue* points = as_points(document_, keys.required("points"), "points");
  node.curve_shape = CurveShape(keys.choice("interpolation", 0, {"linear", "smooth", "steps"}));
  if (points == nullptr) {
    return;
  }
  for (const JsonValue& item : points->items) {
    if (item.kind != JsonKind::array || item.items.size() != 2) {
      document_.fault(item, as_found(item) + ": expected a point, an array of 2 numbers");
      continue;
    }
    const auto x = as_float(document_, item.items[0]);
    const auto y = as_float(document_, item.items[1]);
    if (x && y && rises(document_, item.items[0], node.list, 2, *x)) {
      node.list.insert(node.list.end(), {*x, *y});
    }
  }
}

void NodeLoader::fill_steps(Node& node, ObjectReader& keys) {
  constexpr NumberRange kRamp{0, 1, false, "a number from 0 to 1"};
  put(node, 2, keys.number("ramp", 0.2, kRamp));
  const JsonValue* levels = keys.optional("levels");
  const JsonValue* step = keys.value().find("step");
  const bool has_offset = keys.value().find("offset") != nullptr;
  put(node, 0, keys.number("step", 1, kPositiveFloat));
  put(node, 1, keys.number("offset", 0, kAnyFloat));
  if ((levels == nullptr) == (step == nullptr) || (levels != nullptr && has_offset)) {
    document_.fault(keys.value(), R"(expected either "levels", or "step" and perhaps "offset")");
    return;
  }
  if (as_points(document_, levels, "levels") == nullptr) {
    return;
  }
  for (const JsonValue& item : levels->items) {
    const auto level = as_float(document_, item);
    if (level && rises(document_, item, node.list, 1, *level)) {
      node.list.push_back(*level);
    }
  }
}

}  // namespace mc::source
