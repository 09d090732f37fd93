// SPDX-License-Identifier: MIT
#include "source/script/stroke.hpp"

#include <algorithm>
#include <cmath>
#include <string>

// Counts are bounded here, before anything is made of them.

namespace mc::source {

namespace {

bool is_point(const JsonValue& v) {
  return v.kind == JsonKind::array && v.items.size() == 3 &&
         std::ranges::all_of(v.items, [](const JsonValue& n) {
           return n.kind == JsonKind::number && std::abs(n.number) <= kMostLength;
         });
}

void fill_points(const JsonDocument& document, ObjectReader& keys, BrushPath& path) {
  const JsonValue* list = keys.required("points");
  if (list == nullptr) return;
  const std::size_t n = list->kind == JsonKind::array ? list->items.size() : 0;
  if (n < 2 || n > Script::kMostPoints) {
    document.fault(*list, as_found(*list) +
                              (list->kind == JsonKind::array ? " of " + std::to_string(n) : "") +
                              ": expected an array of 2 to " + std::to_string(Script::kMostPoints) +
                              " points");
    return;
  }
  path.points.reserve(n);
  for (const JsonValue& item : list->items) {
    if (!is_point(item)) {
      document.fault(item, "expected a point: an array of 3 numbers within +-1e15");
      return;
    }
    path.points.push_back({item.items[0].number, item.items[1].number, item.items[2].number});
  }
}

/// A set of axes: "x", "zx", ...
std::array<bool, 3> read_axes(const JsonDocument& document, const JsonValue& value) {
  std::array<bool, 3> axes{};
  bool good = value.kind == JsonKind::string && !value.text.empty();
  for (const char c : value.text) {
    const std::size_t axis = std::string_view("xyz").find(c);
    good = good && axis != std::string_view::npos && !axes[axis];
    if (good) axes[axis] = true;
  }
  if (!good) {
    document.fault(value, as_found(value) +
                              R"(: expected axes, each once: "x", "y", "z", "xy", "xz", "yz" or )"
                              R"("xyz")");
    return {};
  }
  return axes;
}

double distance(const Vec3& a, const Vec3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

std::optional<BrushPath> read_path(const JsonDocument& document, const JsonValue& value) {
  BrushPath path;
  ObjectReader keys(document, value, "a path");
  fill_points(document, keys, path);
  path.mode = PathMode(keys.choice("mode", 0, {"dabs", "sweep"}));
  constexpr NumberRange kSpacing{1e-4, 1e4, false, "a number from 0.0001 to 10000"};
  path.spacing = keys.number("spacing", 0.25, kSpacing);
  if (const JsonValue* at = keys.value().find("spacing");
      at != nullptr && path.mode == PathMode::sweep) {
    document.fault(*at, R"(is of no use to a sweep: expected none, or "mode": "dabs")");
  }
  keys.finish();
  if (path.points.size() < 2) return std::nullopt;
  return path;
}

std::optional<Mirror> read_mirror(const JsonDocument& document, const JsonValue& value) {
  Mirror mirror;
  if (value.kind == JsonKind::string) {
    mirror.axes = read_axes(document, value);
    return mirror;
  }
  ObjectReader keys(document, value, "a mirror");
  if (const JsonValue* axes = keys.required("axes")) mirror.axes = read_axes(document, *axes);
  mirror.at = keys.numbers<3>("at", Vec3{0, 0, 0}, kPlace);
  keys.finish();
  return mirror;
}

std::optional<Radial> read_radial(const JsonDocument& document, const JsonValue& value) {
  constexpr std::int64_t kMostCopies = 10000;
  Radial radial;
  ObjectReader keys(document, value, "a radial symmetry");
  radial.count = static_cast<std::uint32_t>(keys.integer("count", std::nullopt, 1, kMostCopies));
  radial.axis = keys.choice("axis", 1, {"x", "y", "z"});
  radial.at = keys.numbers<3>("at", Vec3{0, 0, 0}, kPlace);
  keys.finish();
  return radial;
}

double path_radius(const BrushShape& shape) {
  const auto least = [](const Vec3& v) { return *std::ranges::min_element(v); };
  switch (shape.type) {
    case ShapeType::sphere:
      return shape.radius;
    case ShapeType::capsule:  // a taper's thin end is spaced as if it were not that thin
      return std::max(std::min(shape.radius, shape.end_radius),
                      std::max(shape.radius, shape.end_radius) / 16);
    case ShapeType::box:
      return least(shape.size) / 2;
    case ShapeType::ellipsoid:
      return least(shape.size);
    case ShapeType::cylinder:
      return std::min(shape.radius, shape.height / 2);
    case ShapeType::cone:
      return std::min(std::max(shape.radius, shape.end_radius), shape.height) / 2;
    default:
      return shape.radius;
  }
}

double most_dabs(const Edit& edit) {
  double n = 1;
  if (edit.path && edit.path->mode == PathMode::dabs) {
    double length = 0;
    for (std::size_t i = 1; i < edit.path->points.size(); ++i) {
      length += distance(edit.path->points[i - 1], edit.path->points[i]);
    }
    n = std::ceil(length / (edit.path->spacing * path_radius(edit.shape))) + 1;
  }
  if (edit.radial) n *= edit.radial->count;
  if (edit.mirror) {
    for (const bool axis : edit.mirror->axes) n *= axis ? 2 : 1;
  }
  return n;
}

}  // namespace mc::source
