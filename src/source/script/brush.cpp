// SPDX-License-Identifier: MIT
#include "source/script/brush.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "field/placing.hpp"

// The keys of shapes are those that mc-volume's solids have.

namespace mc::source {

namespace {

using field::Matrix3;
using field::product;
using field::rotation_about;

constexpr Matrix3 kIdentity{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

Turn turn_of(const Matrix3& m) {
  Turn turn;
  for (std::size_t n = 0; n < 9; ++n) turn.m[n] = m[n / 3][n % 3];
  return turn;
}

Matrix3 rotation(const Vec3& degrees) {
  Matrix3 turned = kIdentity;
  for (std::size_t n = 0; n < 3; ++n) {
    if (degrees[n] != 0) turned = product(rotation_about(kIdentity[n], degrees[n]), turned);
  }
  return turned;
}

/// "rotate", after "axis" has laid the brush's y along it.
Turn read_axis_turn(ObjectReader& keys) {
  const Vec3 degrees = keys.numbers<3>("rotate", Vec3{0, 0, 0}, kPlace);
  const std::size_t axis = keys.choice("axis", 1, {"x", "y", "z"});
  Matrix3 laid = kIdentity;
  if (axis == 0) laid = rotation_about(kIdentity[2], -90);
  if (axis == 2) laid = rotation_about(kIdentity[0], 90);
  return turn_of(product(rotation(degrees), laid));
}

/// "rounding", which leaves something of the least half extent.
void read_rounding(const JsonDocument& document, ObjectReader& keys, BrushShape& shape,
                   double least_half) {
  shape.rounding = keys.number("rounding", 0, kLengthOrZero);
  if (const JsonValue* at = keys.value().find("rounding");
      at != nullptr && shape.rounding > least_half) {
    document.fault(*at, as_found(*at) + ": expected at most half the shape's least extent");
    shape.rounding = 0;
  }
}

void fill_box(const JsonDocument& document, ObjectReader& keys, BrushShape& shape) {
  shape.size = keys.numbers<3>("size", std::nullopt, kLength, true);
  shape.turn = read_rotation(keys, "rotate");
  read_rounding(document, keys, shape, *std::ranges::min_element(shape.size) / 2);
}

void fill_capsule(ObjectReader& keys, BrushShape& shape, bool on_path) {
  const auto radius = keys.numbers<2>("radius", std::nullopt, kLength, true);
  shape.radius = radius[0];
  shape.end_radius = radius[1];
  if (on_path) return;
  shape.center = keys.numbers<3>("from", std::nullopt, kPlace);
  shape.end = keys.numbers<3>("to", std::nullopt, kPlace);
}

void fill_cylinder(const JsonDocument& document, ObjectReader& keys, BrushShape& shape) {
  shape.radius = keys.number("radius", std::nullopt, kLength);
  shape.height = keys.number("height", std::nullopt, kLength);
  shape.turn = read_axis_turn(keys);
  read_rounding(document, keys, shape, std::min(shape.radius, shape.height / 2));
}

/// "radius" is that of the bottom, the top being a point, or both.
void fill_cone(const JsonDocument& document, ObjectReader& keys, BrushShape& shape) {
  const JsonValue* at = keys.value().find("radius");
  if (at != nullptr && at->kind == JsonKind::array) {
    const auto radii = keys.numbers<2>("radius", std::nullopt, kLengthOrZero);
    shape.radius = radii[0];
    shape.end_radius = radii[1];
    if (radii[0] == 0 && radii[1] == 0) {
      document.fault(*at, "has two zeros: expected one number above 0");
      shape.radius = 1;
    }
  } else {
    shape.radius = keys.number("radius", std::nullopt, kLength);
  }
  shape.height = keys.number("height", std::nullopt, kLength);
  shape.turn = read_axis_turn(keys);
}

void fill_node(const JsonDocument& document, ScriptContext& context, ObjectReader& keys,
               BrushShape& shape) {
  shape.radius = keys.number("radius", 0, kLengthOrZero);
  const JsonValue* field = keys.required("field");
  if (field != nullptr) shape.field = read_node(document, context, *field);
  shape.bounds = {Vec3{-1, -1, -1}, Vec3{1, 1, 1}};
  const JsonValue* bounds = keys.required("bounds");
  if (bounds == nullptr) return;
  const auto is_corner = [](const JsonValue& v) {
    return v.kind == JsonKind::array && v.items.size() == 3 &&
           std::ranges::all_of(v.items, [](const JsonValue& n) {
             return n.kind == JsonKind::number && std::abs(n.number) <= kMostLength;
           });
  };
  if (bounds->kind != JsonKind::array || bounds->items.size() != 2 ||
      !std::ranges::all_of(bounds->items, is_corner)) {
    document.fault(*bounds, "expected the lowest and the highest corner: [[x, y, z], [x, y, z]]");
    return;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t n = 0; n < 2; ++n) shape.bounds[n][a] = bounds->items[n].items[a].number;
    if (!(shape.bounds[0][a] < shape.bounds[1][a])) {
      document.fault(*bounds,
                     "hold nothing: expected each number of the first corner below its "
                     "partner in the second");
      shape.bounds = {Vec3{-1, -1, -1}, Vec3{1, 1, 1}};
      return;
    }
  }
}

const std::vector<std::string>& shape_names() {
  static const std::vector<std::string> kNames{"sphere", "box",       "capsule", "cylinder",
                                               "cone",   "ellipsoid", "plane",   "node"};
  return kNames;
}

const std::vector<std::string>& falloff_names() {
  static const std::vector<std::string> kNames{"hard",      "linear", "smoothstep", "smootherstep",
                                               "spherical", "tip",    "curve",      "none"};
  return kNames;
}

/// Points of a curve: t from 0 to 1, w within [0, 1].
void fill_curve(const JsonDocument& document, ObjectReader& keys, Falloff& falloff) {
  constexpr std::size_t kMost = 256;
  const JsonValue* list = keys.required("points");
  if (list == nullptr) return;
  if (list->kind != JsonKind::array || list->items.size() < 2 || list->items.size() > kMost) {
    document.fault(*list, "expected 2 to 256 pairs [t, w]");
    return;
  }
  double last = -1;
  for (const JsonValue& item : list->items) {
    const auto is_part = [](const JsonValue& v) {
      return v.kind == JsonKind::number && v.number >= 0 && v.number <= 1;
    };
    if (item.kind != JsonKind::array || item.items.size() != 2 ||
        !std::ranges::all_of(item.items, is_part)) {
      document.fault(item, "expected a pair [t, w] of numbers from 0 to 1");
      return;
    }
    if (!(item.items[0].number > last)) {
      document.fault(item, "does not rise: expected a t above the one before");
      return;
    }
    last = item.items[0].number;
    falloff.points.push_back({last, item.items[1].number});
  }
  if (falloff.points.front()[0] != 0 || last != 1) {
    document.fault(*list, "expected t to run from 0 to 1");
  }
}

/// The place of a name; none is a fault, with the nearest name.
std::optional<std::size_t> place_among(const JsonDocument& document, const JsonValue& value,
                                       const char* what, const std::vector<std::string>& names) {
  const auto at = std::ranges::find(names, value.text);
  if (value.kind == JsonKind::string && at != names.end()) {
    return static_cast<std::size_t>(at - names.begin());
  }
  document.fault(value, value.kind == JsonKind::string
                            ? std::string("there is no ") + what + " " + in_quotes(value.text) +
                                  "; " + suggestion(value.text, names)
                            : as_found(value) + ": expected the name of a " + what);
  return std::nullopt;
}

}  // namespace

Vec3 read_direction(const JsonDocument& document, ObjectReader& keys, const char* key) {
  const Vec3 n = keys.numbers<3>(key, Vec3{0, 1, 0}, kPlace);
  const double length = std::sqrt((n[0] * n[0] + n[1] * n[1]) + n[2] * n[2]);
  if (!(length > 0)) {
    document.fault(*keys.value().find(key), "has no direction: expected a length above 0");
    return {0, 1, 0};
  }
  return {n[0] / length, n[1] / length, n[2] / length};
}

Turn read_rotation(ObjectReader& keys, const char* key) {
  return turn_of(rotation(keys.numbers<3>(key, Vec3{0, 0, 0}, kPlace)));
}

BrushShape read_shape(const JsonDocument& document, ScriptContext& context, const JsonValue& value,
                      bool on_path) {
  BrushShape shape;
  shape.radius = 1;
  ObjectReader keys(document, value, "a shape");
  const JsonValue* type = keys.required("type");
  const auto place =
      type == nullptr ? std::nullopt : place_among(document, *type, "shape", shape_names());
  if (!place) return shape;
  shape.type = ShapeType(*place);
  const std::string what = "a shape of type " + in_quotes(type->text);
  ObjectReader own(document, value, what.c_str());
  own.optional("type");
  if (shape.type != ShapeType::capsule) {
    shape.center = own.numbers<3>("center", Vec3{0, 0, 0}, kPlace);
  }
  switch (shape.type) {
    case ShapeType::sphere:
      shape.radius = own.number("radius", std::nullopt, kLength);
      break;
    case ShapeType::box:
      fill_box(document, own, shape);
      break;
    case ShapeType::capsule:
      fill_capsule(own, shape, on_path);
      break;
    case ShapeType::cylinder:
      fill_cylinder(document, own, shape);
      break;
    case ShapeType::cone:
      fill_cone(document, own, shape);
      break;
    case ShapeType::ellipsoid:
      shape.size = own.numbers<3>("radii", std::nullopt, kLength, true);
      shape.turn = read_rotation(own, "rotate");
      break;
    case ShapeType::plane:
      shape.normal = read_direction(document, own, "normal");
      shape.radius = own.number("radius", 0, kLengthOrZero);
      break;
    default:
      fill_node(document, context, own, shape);
  }
  own.finish();
  return shape;
}

Falloff read_falloff(const JsonDocument& document, const JsonValue& value) {
  Falloff falloff;
  if (value.kind == JsonKind::string) {
    const auto place = place_among(document, value, "falloff", falloff_names());
    if (place && FalloffType(*place) == FalloffType::curve) {
      document.fault(value, R"(needs its points: expected {"type": "curve", "points": ...})");
    } else if (place) {
      falloff.type = FalloffType(*place);
    }
    return falloff;
  }
  ObjectReader keys(document, value, "a falloff");
  const JsonValue* type = keys.required("type");
  const auto place =
      type == nullptr ? std::nullopt : place_among(document, *type, "falloff", falloff_names());
  if (!place) return falloff;
  falloff.type = FalloffType(*place);
  const std::string what = "a falloff of type " + in_quotes(type->text);
  ObjectReader own(document, value, what.c_str());
  own.optional("type");
  if (falloff.type != FalloffType::none && falloff.type != FalloffType::hard) {
    constexpr NumberRange kInner{0, 0.9999999999999999, false, "a number from 0 to below 1"};
    falloff.inner = own.number("inner", 0, kInner);
  }
  if (falloff.type == FalloffType::curve) fill_curve(document, own, falloff);
  own.finish();
  return falloff;
}

}  // namespace mc::source
