// SPDX-License-Identifier: MIT
#include "graph/bounds.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

#include "graph/bounds_data.hpp"
#include "graph/bounds_noise.hpp"
#include "graph/bounds_shape.hpp"
#include "graph/float_math.hpp"
#include "graph/interval_math.hpp"

// One case for each operation. Whoever adds an operation and knows no bounds says kUnknown: it is
// then sampled everywhere.

namespace mc::graph {

namespace {

Interval fraction(Interval a) {
  const float cell = exact_floor(a.lo);
  if (cell != exact_floor(a.hi)) return between(0, 1);  // 1 by rounding, just below an integer
  return between(a.lo - cell, a.hi - cell);
}

/// exact_sin is within 2e-7 of the sine up to 8192.
Interval sine(Interval a) {
  constexpr double kPi = 3.14159265358979323846;
  constexpr float kError = 1e-6F;
  if (size_of(a) > 8192 || double{a.hi} - double{a.lo} >= 2 * kPi) return between(-1, 1);
  const double from = double{a.lo} / kPi - 0.5;  // extremes are at integers
  const double to = double{a.hi} / kPi - 0.5;
  Interval out = widened(hull(exact_sin(a.lo), exact_sin(a.hi)), kError);
  const auto last = static_cast<std::int32_t>(std::floor(to + 1e-6));
  for (auto n = static_cast<std::int32_t>(std::ceil(from - 1e-6)); n <= last; ++n) {
    (n % 2 == 0 ? out.hi : out.lo) = n % 2 == 0 ? 1.0F : -1.0F;
  }
  return between(std::max(out.lo, -1.0F), std::min(out.hi, 1.0F));
}

/// exact_pow of a base that is not negative: |b log2 a| is largest at a corner, and so is the
/// relative error of 2e-7 of each unit of it. Bases below 2^-126 count as zero, and so do results.
Interval power_of_positive(Interval a, Interval b) {
  constexpr float kLeast = 0x1p-120F;
  if (a.lo < kLeast && !(b.lo > 0)) return kUnknown;
  const auto exponent = [](float u, float v) { return v * exact_log2(greatest(u, kLeast)); };
  const Interval e = over_corners(a, b, exponent);
  if (!(e.hi < 120)) return kUnknown;
  const bool vanishes = a.lo < kLeast || e.lo < -100;
  const float slack = 1e-6F * (1 + size_of(e));
  return between(vanishes ? 0 : exact_exp2(e.lo) * (1 - slack),
                 exact_exp2(std::max(e.hi, -100.0F)) * (1 + slack));
}

Interval power(Interval a, Interval b) {
  if (a.lo >= 0) return power_of_positive(a, b);
  const bool whole = b.single() && exact_floor(b.lo) == b.lo && b.lo > 0;
  if (!whole) return kUnknown;
  const Interval size = power_of_positive(magnitude(a), b);
  if (std::fmod(b.lo, 2.0F) == 0) return size;
  return a.hi <= 0 ? between(-size.hi, -size.lo) : between(-size.hi, size.hi);
}

/// a - b floor(a / b), with a divisor of one sign.
Interval remainder(Interval a, Interval b) {
  if (holds_zero(b)) return kUnknown;
  const Interval turns = quotient(a, b);
  if (!turns.known()) return kUnknown;
  const float turn = exact_floor(turns.lo);
  if (b.single() && turn == exact_floor(turns.hi)) {
    return between(a.lo - b.lo * turn, a.hi - b.lo * turn);
  }
  // A quotient rounded to an integer, and what the product and the difference lose.
  const float slack = (size_of(a) + size_of(b)) * 0x1p-20F;
  return b.lo > 0 ? between(-slack, b.hi + slack) : between(b.lo - slack, slack);
}

Interval smooth_step(Interval a, float edge, float width) {
  const Interval t = monotone(a, [&](float v) { return clamped((v - edge) / width, 0.0F, 1.0F); });
  const auto s = [](float v) { return (v * v) * (3.0F - 2.0F * v); };
  if (!t.known() || width == 0) return kUnknown;
  if (t.single()) return between(s(t.lo), s(t.lo));
  return between(s(t.lo) * (1 - 0x1p-20F), s(t.hi) * (1 + 0x1p-20F));
}

/// a + (b - a) c: also between a and b, but for rounding, where c is a fraction.
Interval mixture(Interval a, Interval b, Interval c) {
  const Interval plain = sum(a, product(difference(b, a), c));
  if (!(c.lo >= 0 && c.hi <= 1)) return plain;
  const float slack = std::max(size_of(a), size_of(b)) * 0x1p-20F;
  const Interval both = widened({std::min(a.lo, b.lo), std::max(a.hi, b.hi)}, slack);
  return plain.known() ? between(std::max(plain.lo, both.lo), std::min(plain.hi, both.hi)) : plain;
}

/// A select's band, of its ends the sides themselves.
Interval blended(Interval a, Interval b, Interval t) {
  if (!t.known()) return kUnknown;
  if (t.hi <= 0) return a;
  if (t.lo >= 1) return b;
  Interval out = mixture(a, b, {std::max(t.lo, 0.0F), std::min(t.hi, 1.0F)});
  if (t.lo <= 0) out = joined(out, a);
  return t.hi >= 1 ? joined(out, b) : out;
}

/// The cubic of a curve for places above its start. It is monotone on its own piece, but for the
/// rounding of its coefficients and steps, and held beyond it.
Interval curve_piece(Interval a, const std::array<float, 6>& p) {
  const auto at = [&](float v) { return least(greatest(v - p[0], 0.0F), p[5]); };
  const auto cubic = [&](float t) { return ((p[4] * t + p[3]) * t + p[2]) * t + p[1]; };
  const float t = at(a.hi);
  const float size = ((std::abs(p[4]) * t + std::abs(p[3])) * t + std::abs(p[2])) * t;
  return widened(hull(cubic(at(a.lo)), cubic(t)), (size + std::abs(p[1])) * 0x1p-20F);
}

/// Within one copy a shift; over several half a period each way, and what lies beyond the last.
Interval repetition(Interval a, const std::array<float, 6>& p) {
  const auto copy = [&](float v) { return clamped(exact_floor(v / p[0] + 0.5F), p[1], p[2]); };
  const auto place = [&](float v) { return v - p[0] * copy(v); };
  const Interval ends = hull(place(a.lo), place(a.hi));
  if (copy(a.lo) == copy(a.hi)) return ends;
  const float slack = (size_of(a) + p[0]) * 0x1p-20F;
  return joined(ends, widened({-0.5F * p[0], 0.5F * p[0]}, slack));
}

Interval weight(Interval amplitude, Interval noise, float gain, float weighted) {
  const Interval factor = monotone(noise, [&](float v) {
    const float level = clamped((v + 1.0F) * 0.5F, 0.0F, 1.0F);
    return gain * (1.0F + weighted * (level - 1.0F));
  });
  return factor.known() ? product(amplitude, factor) : kUnknown;
}

float blend(float a, float b, float k) {
  const float h = greatest(k - std::abs(a - b), 0.0F) / k;
  return ((h * h) * k) * 0.25F;
}

/// A smooth minimum never falls when an input rises, but for rounding.
Interval smooth_least(Interval a, Interval b, float k) {
  const float slack = (std::max(size_of(a), size_of(b)) + k) * 0x1p-20F;
  return widened(
      {least(a.lo, b.lo) - blend(a.lo, b.lo, k), least(a.hi, b.hi) - blend(a.hi, b.hi, k)}, slack);
}

Interval negative(Interval a) { return {-a.hi, -a.lo}; }

Interval sphere(const Interval (&at)[3], const Instruction& instruction) {
  const auto& p = instruction.p;
  Interval squares = square(difference(at[0], {p[0], p[0]}));
  squares = sum(squares, square(difference(at[1], {p[1], p[1]})));
  squares = sum(squares, square(difference(at[2], {p[2], p[2]})));
  return difference({p[3], p[3]}, root(squares));
}

/// The distance never falls when one from a pair of sides rises.
Interval box(const Interval (&at)[3], const Instruction& instruction) {
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

Interval plane(const Interval (&at)[3], const Instruction& instruction) {
  const auto& p = instruction.p;
  const auto along = [&](std::size_t n) { return product(at[n], {p[n], p[n]}); };
  return difference({p[3], p[3]}, sum(sum(along(0), along(1)), along(2)));
}

Interval torus(const Interval (&at)[3], const Instruction& instruction) {
  const auto& p = instruction.p;
  const auto from = [&](std::size_t n) { return square(difference(at[n], {p[n], p[n]})); };
  const Interval from_ring = difference(root(sum(from(0), from(2))), {p[3], p[3]});
  return difference({p[4], p[4]}, root(sum(square(from_ring), from(1))));
}

}  // namespace

Interval bounds_of(const Instruction& instruction, const WorldBox& world, Interval a, Interval b,
                   Interval c) noexcept {
  const Interval in[3] = {a, b, c};
  assert(instruction.n_in <= std::size(in));
  for (std::size_t n = 0; n < instruction.n_in; ++n) {
    if (!in[n].known()) return kUnknown;
  }
  const auto& p = instruction.p;
  const bool same = instruction.in[0] == instruction.in[1];
  switch (instruction.op) {
    case Op::fill:
      return between(p[0], p[0]);
    case Op::x:
      return world[0];
    case Op::y:
      return world[1];
    case Op::z:
      return world[2];
    case Op::add:
      return sum(a, b);
    case Op::sub:
      return difference(a, b);
    case Op::mul:
      return same ? square(a) : product(a, b);
    case Op::div:
      return quotient(a, b);
    case Op::min:
      return between(std::min(a.lo, b.lo), std::min(a.hi, b.hi));
    case Op::max:
      return between(std::max(a.lo, b.lo), std::max(a.hi, b.hi));
    case Op::pow:
      return power(a, b);
    case Op::mod:
      return remainder(a, b);
    case Op::abs:
      return magnitude(a);
    case Op::neg:
      return negative(a);
    case Op::sqrt:
      return root(a);
    case Op::floor:
      return rising(a, exact_floor);
    case Op::fract:
      return fraction(a);
    case Op::sin:
      return sine(a);
    case Op::clamp:
      return rising(a, [&](float v) { return clamped(v, p[0], p[1]); });
    case Op::remap:
      return monotone(a, [&](float v) { return (v - p[0]) * p[1] + p[2]; });
    case Op::smoothstep:
      return smooth_step(a, p[0], p[1]);
    case Op::mix:
      return mixture(a, b, c);
    case Op::select:
      return c.hi < p[0] ? a : c.lo >= p[0] ? b : joined(a, b);
    case Op::blend:
      return blended(a, b, smooth_step(c, p[0], p[1]));
    case Op::curve:
      return a.hi < p[0] ? b : a.lo >= p[0] ? curve_piece(a, p) : joined(b, curve_piece(a, p));
    case Op::terrace:
      return rising(a, [&](float v) { return terraced(v, p); });
    case Op::repeat:
      return repetition(a, p);
    case Op::scale:
      return monotone(a, [&](float v) { return v * p[0]; });
    case Op::accumulate:
      return sum(a, monotone(b, [&](float v) { return v * p[0]; }));
    case Op::multiply_add:
      return sum(a, product(b, c));
    case Op::weigh:
      return weight(a, b, p[0], p[1]);
    case Op::ridge: {
      const Interval size = magnitude(a);
      return between(1.0F - 2.0F * size.hi, 1.0F - 2.0F * size.lo);
    }
    case Op::billow: {
      const Interval size = magnitude(a);
      return between(2.0F * size.lo - 1.0F, 2.0F * size.hi - 1.0F);
    }
    case Op::pingpong:  // rounding of huge numbers may leave the fold
      return size_of(a) * p[0] < 0x1p20F ? between(-1.001F, 1.001F) : kUnknown;
    case Op::offset:
      return rising(a, [&](float v) { return p[0] + v; });
    case Op::mirror:
      return between(p[0] - a.hi, p[0] - a.lo);
    case Op::smooth_min:
      return smooth_least(a, b, p[0]);
    case Op::smooth_max:
      return negative(smooth_least(negative(a), negative(b), p[0]));
    case Op::perlin2:
    case Op::perlin3:
    case Op::simplex2:
    case Op::simplex3:
    case Op::unity2:
    case Op::open_simplex2:
    case Op::open_simplex3:
    case Op::value2:
    case Op::value3:
    case Op::value_cubic2:
    case Op::value_cubic3:
    case Op::cellular2:
    case Op::cellular3:
    case Op::white2:
    case Op::white3:
      return noise_bounds(instruction, in);
    case Op::sphere:
      return sphere(in, instruction);
    case Op::box:
      return box(in, instruction);
    case Op::plane:
      return plane(in, instruction);
    case Op::torus:
      return torus(in, instruction);
    case Op::heightmap:
      return heightmap_bounds(instruction, in);
    case Op::volume:
      return volume_bounds(instruction, in);
    case Op::cylinder:
      return cylinder_bounds(instruction, in);
    case Op::cone:
    case Op::capsule:
      return distance_bounds(instruction, in);
    case Op::ellipsoid:
      return ellipsoid_bounds(instruction, in);
    case Op::gyroid:
      return gyroid_bounds(instruction, in);
    case Op::copy:
      return a;
  }
  return kUnknown;
}

}  // namespace mc::graph
