// SPDX-License-Identifier: MIT
#include "graph/bounds_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "graph/float_math.hpp"
#include "graph/interval_math.hpp"
#include "graph/rows.hpp"

namespace mc::graph {

namespace {

/// The middle of the box, how far its corners are from there, and the farthest coordinate.
struct Middle {
  std::array<float, 3> at{};
  float reach = 0;
  float farthest = 0;
};

Middle middle_of(const Interval (&at)[3]) {
  Middle middle;
  float square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float m = 0.5F * at[axis].lo + 0.5F * at[axis].hi;
    const float half = std::max(at[axis].hi - m, m - at[axis].lo);
    middle.at[axis] = m;
    square += half * half;
    middle.farthest = std::max(middle.farthest, size_of(at[axis]));
  }
  middle.reach = __builtin_sqrtf(square);
  return middle;
}

float solid_at(const Instruction& instruction, const std::array<float, 3>& at) {
  std::array<std::array<float, kRowStep>, 3> rows{};  // of which the first counts
  for (std::size_t axis = 0; axis < 3; ++axis) rows[axis].fill(at[axis]);
  std::array<float, kRowStep> value{};
  solid_row(instruction, rows[0].data(), rows[1].data(), rows[2].data(), 1, value.data());
  return value[0];
}

Interval from(Interval at, float centre) { return difference(at, {centre, centre}); }

Interval hypotenuse(Interval a, Interval b) { return root(sum(square(a), square(b))); }

}  // namespace

Interval sphere_bounds(const Instruction& instruction, const Interval (&at)[3]) {
  const auto& p = instruction.p;
  Interval squares = square(difference(at[0], {p[0], p[0]}));
  squares = sum(squares, square(difference(at[1], {p[1], p[1]})));
  squares = sum(squares, square(difference(at[2], {p[2], p[2]})));
  return difference({p[3], p[3]}, root(squares));
}

/// The distance never falls when one from a pair of sides rises.
Interval box_bounds(const Instruction& instruction, const Interval (&at)[3]) {
  const auto& p = instruction.p;
  Interval q[3];
  for (std::size_t n = 0; n < 3; ++n) {
    const Interval from = magnitude(difference(at[n], {p[n], p[n]}));
    q[n] = difference(from, {p[n + 3] * 0.5F, p[n + 3] * 0.5F});
  }
  const auto inside = [](float x, float y, float z) {
    const float ox = greatest(x, 0.0F);
    const float oy = greatest(y, 0.0F);
    const float oz = greatest(z, 0.0F);
    const float outside = __builtin_sqrtf((ox * ox + oy * oy) + oz * oz);
    return -(outside + least(greatest(x, greatest(y, z)), 0.0F));
  };
  if (!q[0].known() || !q[1].known() || !q[2].known()) return kUnknown;
  return between(inside(q[0].hi, q[1].hi, q[2].hi), inside(q[0].lo, q[1].lo, q[2].lo));
}

Interval plane_bounds(const Instruction& instruction, const Interval (&at)[3]) {
  const auto& p = instruction.p;
  const auto along = [&](std::size_t n) { return product(at[n], {p[n], p[n]}); };
  return difference({p[3], p[3]}, sum(sum(along(0), along(1)), along(2)));
}

Interval torus_bounds(const Instruction& instruction, const Interval (&at)[3]) {
  const auto& p = instruction.p;
  const auto from = [&](std::size_t n) { return square(difference(at[n], {p[n], p[n]})); };
  const Interval from_ring = difference(root(sum(from(0), from(2))), {p[3], p[3]});
  return difference({p[4], p[4]}, root(sum(square(from_ring), from(1))));
}

Interval cylinder_bounds(const Instruction& instruction, const Interval (&at)[3]) {
  const auto& p = instruction.p;
  const Interval out = from(hypotenuse(from(at[0], p[0]), from(at[2], p[2])), p[3]);
  const Interval over = from(magnitude(from(at[1], p[1])), p[4]);
  if (!out.known() || !over.known()) return kUnknown;
  // It never rises with either.
  const auto inside = [](float x, float y) {
    const float ox = greatest(x, 0.0F);
    const float oy = greatest(y, 0.0F);
    return -(__builtin_sqrtf(ox * ox + oy * oy) + least(greatest(x, y), 0.0F));
  };
  return between(inside(out.hi, over.hi), inside(out.lo, over.lo));
}

Interval distance_bounds(const Instruction& instruction, const Interval (&at)[3]) {
  const Middle middle = middle_of(at);
  float size = middle.farthest;
  for (const float v : instruction.p) size += std::abs(v);
  const float value = solid_at(instruction, middle.at);
  return widened({value, value}, middle.reach * (1 + 0x1p-20F) + size * 0x1p-18F);
}

Interval ellipsoid_bounds(const Instruction& instruction, const Interval (&at)[3]) {
  const auto& p = instruction.p;
  Interval k0_squared{0, 0};
  Interval k1_squared{0, 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Interval radius{p[3 + axis], p[3 + axis]};
    const Interval part = quotient(from(at[axis], p[axis]), radius);
    k0_squared = sum(k0_squared, square(part));
    k1_squared = sum(k1_squared, square(quotient(part, radius)));
  }
  const Interval k0 = root(k0_squared);
  const float low = least(p[3], least(p[4], p[5]));
  const float high = greatest(p[3], greatest(p[4], p[5]));
  const Interval plain = quotient(k0, root(k1_squared));
  const Interval ratio = plain.known()
                             ? rising(plain, [&](float v) { return clamped(v, low, high); })
                             : between(low, high);
  const Interval value = product(difference({1, 1}, k0), ratio);
  return k0.lo < 1e-6F ? joined(value, {low, low}) : value;
}

Interval gyroid_bounds(const Instruction& instruction, const Interval (&at)[3]) {
  constexpr float kSlope = 3.0F;  // 2.74, where the slope's least value is held; see the tests
  const float k = instruction.p[3];
  const Middle middle = middle_of(at);
  float size = middle.farthest;
  for (std::size_t axis = 0; axis < 3; ++axis) size += std::abs(instruction.p[axis]);
  if (!(size * k < 8000.0F)) return between(-3.1F / k, 3.1F / k);  // sines lose their digits
  const float most = 1.51F / k;
  const float reach = kSlope * (middle.reach + size * 0x1p-20F) + 1e-4F / k;
  const float value = solid_at(instruction, middle.at);
  return between(std::max(-most, value - reach), std::min(most, value + reach));
}

}  // namespace mc::graph
