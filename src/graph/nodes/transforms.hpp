// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "field/placing.hpp"
#include "graph/nodes/arithmetic.hpp"

// Transforms. A document says where a thing goes; a node holds the way back, which is where its
// source is looked up.

namespace mc::graph {

/// The products of coordinates and a matrix row, which ends with a number of its own, from left to
/// right; without those whose factor is 0, so that what does not depend on y is seen not to.
inline Value emit_linear(Emitter& to, const Domain& domain, const float* row) {
  std::optional<Value> sum;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Value at = domain.at[axis];
    if (row[axis] != 0) {
      sum = sum              ? to.push(Op::accumulate, {*sum, at}, {row[axis]})
            : row[axis] == 1 ? at
                             : to.push(Op::scale, {at}, {row[axis]});
    }
  }
  if (!sum) {
    return to.push(Op::fill, {}, {row[3]});
  }
  return row[3] == 0 ? *sum : to.push(Op::offset, {*sum}, {row[3]});
}

inline std::array<Value, 3> emit_moved(Emitter& to, const Domain& domain,
                                       const std::vector<float>& matrix) {
  return {emit_linear(to, domain, &matrix[0]), emit_linear(to, domain, &matrix[4]),
          emit_linear(to, domain, &matrix[8])};
}

inline Value emit_affine(Emitter& to, const Node& node, const Domain& domain) {
  Domain there = domain;
  there.at = emit_moved(to, domain, node.list);
  const Value value = to.emit(node.inputs[0], there);
  const float iso = to.settings().iso;
  const float factor = node.numbers[0];
  return factor != 0 ? to.push(Op::remap, {value}, {iso, factor, iso}) : value;
}

inline Value emit_mirror(Emitter& to, const Node& node, const Domain& domain) {
  const auto& p = node.numbers;
  Domain there = domain;
  Value& at = there.at[node.axis];
  const Value away = to.push(Op::abs, {to.push(Op::offset, {at}, {-p[0]})});
  at = to.push(p[1] > 0 ? Op::offset : Op::mirror, {away}, {p[0]});
  return to.emit(node.inputs[0], there);
}

inline Value emit_repeat(Emitter& to, const Node& node, const Domain& domain) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto& p = node.numbers;
  Domain there = domain;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float copies = p[3 + axis];
    const float first = copies > 0 ? 0.0F : -kInfinity;
    const float last = copies > 0 ? copies - 1.0F : kInfinity;
    if (p[axis] > 0) {
      there.at[axis] = to.push(Op::repeat, {domain.at[axis]}, {p[axis], first, last});
    }
  }
  return to.emit(node.inputs[0], there);
}

inline bool is_matrix(std::span<const float> list) { return list.size() == 12; }

inline constexpr field::Matrix3 kIdentity{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

/// The direction of the vector that `key` gives; one without a direction is a fault.
inline std::optional<Vec3> direction_of(GivenKeys& given, const char* key) {
  const Vec3 v = given.vector(key);
  const double length = std::sqrt((v[0] * v[0] + v[1] * v[1]) + v[2] * v[2]);
  if (length > 0) return Vec3{v[0] / length, v[1] / length, v[2] / length};
  given.fault(key, "has no direction: expected a length above 0");
  return std::nullopt;
}

inline void make_translation(Node& node, GivenKeys& given) {
  node.list = field::placed(kIdentity, given.vector("by"), {0, 0, 0});
}

/// One angle about "axis", or three: about x, then y, then z.
inline field::Matrix3 rotation_of(GivenKeys& given) {
  const Vec3 degrees = given.vector("degrees");
  if (!given["degrees"].is_array) {
    const auto& axis = given["axis"];
    const std::optional<Vec3> about =
        axis.is_array ? direction_of(given, "axis") : kIdentity[axis.choice];
    return field::rotation_about(about.value_or(kIdentity[1]), degrees[0]);
  }
  field::Matrix3 turned = kIdentity;
  for (std::size_t n = 0; n < 3; ++n) {
    turned = field::product(field::rotation_about(kIdentity[n], degrees[n]), turned);
  }
  return turned;
}

inline void make_rotation(Node& node, GivenKeys& given) {
  const Vec3 center = given.vector("center");
  node.list = field::placed(field::transposed(rotation_of(given)), center, center);
}

inline double least_factor(const GivenKeys& given) {
  const Vec3 factor = given.vector("factor");
  return std::min({std::abs(factor[0]), std::abs(factor[1]), std::abs(factor[2])});
}

/// If a factor is 0, the keys after it count as unknown.
inline bool has_inverse(const GivenKeys& given) {
  return !given["factor"].present || least_factor(given) >= kPositiveFloat.lo;
}

inline void make_scaling(Node& node, GivenKeys& given) {
  if (!has_inverse(given)) return;
  const Vec3 factor = given.vector("factor");
  const Vec3 center = given.vector("center");
  const field::Matrix3 inverse{
      Vec3{1 / factor[0], 0, 0}, {0, 1 / factor[1], 0}, {0, 0, 1 / factor[2]}};
  node.list = field::placed(inverse, center, center);
  if (given["values"].choice == 1) {
    node.numbers[0] = static_cast<float>(least_factor(given));
  }
}

inline void make_affine(Node& node, GivenKeys& given) {
  const auto& m = given["matrix"].numbers;
  const auto inverse =
      field::inverse_of({Vec3{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}});
  if (inverse) {
    node.list = field::placed(*inverse, {m[3], m[7], m[11]}, {0, 0, 0});
  }
  const auto finite = [](float v) { return std::isfinite(v); };
  const bool good = inverse && std::all_of(node.list.begin(), node.list.end(), finite);
  if (given["matrix"].is_complete && !good) {
    given.fault("matrix", "cannot be inverted: expected a matrix that keeps all three dimensions");
  }
}

inline bool has_one_angle(const GivenKeys& given) { return !given["degrees"].is_array; }

inline void set_axis(Node& node, double n) { node.axis = static_cast<std::uint8_t>(n); }

inline constexpr NumberRange kCopyCounts{0, 16777216, false, "an integer from 0 to 16777216"};

inline constexpr NodeKey kCenter = or_else(numbers_key("center", 3, -1, kAnyFloat), 0);

inline constexpr NodeRow kTransforms[] = {
    {.type = NodeType::affine,
     .name = "translate",
     .keys = {kSource, numbers_key("by", 3, -1, kAnyFloat)},
     .emit = emit_affine,
     .make = make_translation,
     .takes_list = is_matrix},
    {.type = NodeType::affine,
     .name = "rotate",
     .keys = {kSource, one_or_more_key("degrees", 3, -1, kAnyFloat, kAnyFloat),
              only_if(or_else(direction_key("axis", {"x", "y", "z"}), 1), has_one_angle,
                      "is of no use beside three \"degrees\": expected no axis, or one angle"),
              kCenter},
     .emit = emit_affine,
     .make = make_rotation,
     .takes_list = is_matrix},
    {.type = NodeType::affine,
     .name = "scale",
     .keys = {kSource,
              without_zero(
                  sizes_key("factor", 3, -1, kAnyFloat),
                  "has a zero: expected numbers other than 0 (1.2e-38 to 3.4e38, float32)"),
              only_if(kCenter, has_inverse),
              only_if(or_else(choice_key("values", {"keep", "scale"}), 0), has_inverse)},
     .emit = emit_affine,
     .make = make_scaling,
     .takes_list = is_matrix},
    {.type = NodeType::affine,
     .name = "affine",
     .keys = {kSource, numbers_key("matrix", 12, -1, kAnyFloat)},
     .emit = emit_affine,
     .make = make_affine,
     .takes_list = is_matrix},
    {.type = NodeType::mirror,
     .name = "mirror",
     .keys = {kSource, choice_key("axis", {"x", "y", "z"}, set_axis),
              or_else(number_key("at", 0, kAnyFloat), 0),
              or_else(choice_key("keep", {"above", "below"},
                                 [](Node& node, double n) { node.numbers[1] = n == 0 ? 1 : -1; }),
                      0)},
     .emit = emit_mirror},
    {.type = NodeType::repeat,
     .name = "repeat",
     .keys = {kSource,
              not_all_zero(sizes_key("period", 3, 0, kFloatNotNegative),
                           "is 0 along all axes: expected one above 0"),
              or_else(whole(sizes_key("copies", 3, 3, kCopyCounts)), 0)},
     .emit = emit_repeat},
};

}  // namespace mc::graph
