// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see rows.hpp for what the functions do.

#if defined(MC_GRAPH_ROWS_ARITHMETIC_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_GRAPH_ROWS_ARITHMETIC_INL
#undef MC_GRAPH_ROWS_ARITHMETIC_INL
#else
#define MC_GRAPH_ROWS_ARITHMETIC_INL
#endif

#include <hwy/highway.h>

#include <cassert>
#include <cmath>

#include "graph/float_math.hpp"
#include "graph/rows.hpp"

// The arithmetic nodes, a row at a time: plain loops that the compiler turns into vectors.

HWY_BEFORE_NAMESPACE();
namespace mc::graph::HWY_NAMESPACE {
namespace {

template <class F>
void map1(Row a, std::size_t n, OutRow out, F f) {
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = f(a[i]);
  }
}

template <class F>
void map2(Row a, Row b, std::size_t n, OutRow out, F f) {
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = f(a[i], b[i]);
  }
}

template <class F>
void map3(Row a, Row b, Row c, std::size_t n, OutRow out, F f) {
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = f(a[i], b[i], c[i]);
  }
}

/// What a smooth minimum takes off: h^2 k / 4 with h = max(k - |a - b|, 0) / k.
float blend(float a, float b, float k) noexcept {
  const float h = greatest(k - std::abs(a - b), 0.0F) / k;
  return ((h * h) * k) * 0.25F;
}

float smooth_step(float v, float edge, float width) noexcept {
  const float t = clamped((v - edge) / width, 0.0F, 1.0F);
  return (t * t) * (3.0F - 2.0F * t);
}

/// Fractal amplitudes: the next one falls where this octave was low.
float weighed(float amplitude, float noise, float gain, float weight) noexcept {
  const float level = clamped((noise + 1.0F) * 0.5F, 0.0F, 1.0F);
  return amplitude * (gain * (1.0F + weight * (level - 1.0F)));
}

/// A triangle wave of period 2 / strength: -1 where (v + 1) * strength is even, 1 where it is odd.
float to_and_fro(float v, float strength) noexcept {
  const float t = (v + 1.0F) * strength;
  const float way = t - 2.0F * exact_floor(t * 0.5F);  // 0 to 2
  return 1.0F - 2.0F * std::abs(way - 1.0F);
}

float modulo(float a, float b) noexcept { return a - b * exact_floor(a / b); }

/// A control that is NaN gives NaN.
float selected(float a, float b, float control, float threshold) noexcept {
  const float upper = control >= threshold ? b : control;
  return control < threshold ? a : upper;
}

/// a and b themselves outside the band.
float blended(float a, float b, float control, float edge, float width) noexcept {
  const float t = smooth_step(control, edge, width);
  const float between = a + (b - a) * t;
  const float upper = t >= 1.0F ? b : between;
  return t <= 0.0F ? a : upper;
}

float curve_piece(float v, float below, const std::array<float, 6>& p) noexcept {
  const float t = least(v - p[0], p[5]);
  const float cubic = ((p[4] * t + p[3]) * t + p[2]) * t + p[1];
  return v < p[0] ? below : cubic;
}

/// The coordinate within the nearest copy.
float repeated(float v, const std::array<float, 6>& p) noexcept {
  return v - p[0] * clamped(exact_floor(v / p[0] + 0.5F), p[1], p[2]);
}

void one_input_row(const Instruction& instruction, Row a, std::size_t n, OutRow out) noexcept {
  const auto& p = instruction.p;
  switch (instruction.op) {
    case Op::abs:
      return map1(a, n, out, [](float u) { return std::abs(u); });
    case Op::neg:
      return map1(a, n, out, [](float u) { return -u; });
    case Op::sqrt:
      return map1(a, n, out, [](float u) { return __builtin_sqrtf(u); });
    case Op::floor:
      return map1(a, n, out, [](float u) { return exact_floor(u); });
    case Op::fract:
      return map1(a, n, out, [](float u) { return u - exact_floor(u); });
    case Op::sin:
      return map1(a, n, out, [](float u) { return exact_sin(u); });
    case Op::clamp:
      return map1(a, n, out, [&](float u) { return clamped(u, p[0], p[1]); });
    case Op::remap:
      return map1(a, n, out, [&](float u) { return (u - p[0]) * p[1] + p[2]; });
    case Op::smoothstep:
      return map1(a, n, out, [&](float u) { return smooth_step(u, p[0], p[1]); });
    case Op::scale:
      return map1(a, n, out, [&](float u) { return u * p[0]; });
    case Op::offset:
      return map1(a, n, out, [&](float u) { return p[0] + u; });
    case Op::mirror:
      return map1(a, n, out, [&](float u) { return p[0] - u; });
    case Op::terrace:
      return map1(a, n, out, [&](float u) { return terraced(u, p); });
    case Op::repeat:
      return map1(a, n, out, [&](float u) { return repeated(u, p); });
    case Op::ridge:
      return map1(a, n, out, [](float u) { return 1.0F - 2.0F * std::abs(u); });
    case Op::billow:
      return map1(a, n, out, [](float u) { return 2.0F * std::abs(u) - 1.0F; });
    case Op::pingpong:
      return map1(a, n, out, [&](float u) { return to_and_fro(u, p[0]); });
    default:
      assert(false && "not an arithmetic instruction");
  }
}

void two_input_row(const Instruction& instruction, Row a, Row b, std::size_t n,
                   OutRow out) noexcept {
  const auto& p = instruction.p;
  switch (instruction.op) {
    case Op::add:
      return map2(a, b, n, out, [](float u, float v) { return u + v; });
    case Op::sub:
      return map2(a, b, n, out, [](float u, float v) { return u - v; });
    case Op::mul:
      return map2(a, b, n, out, [](float u, float v) { return u * v; });
    case Op::div:
      return map2(a, b, n, out, [](float u, float v) { return u / v; });
    case Op::min:
      return map2(a, b, n, out, [](float u, float v) { return least(u, v); });
    case Op::max:
      return map2(a, b, n, out, [](float u, float v) { return greatest(u, v); });
    case Op::pow:
      return map2(a, b, n, out, [](float u, float v) { return exact_pow(u, v); });
    case Op::mod:
      return map2(a, b, n, out, [](float u, float v) { return modulo(u, v); });
    case Op::accumulate:
      return map2(a, b, n, out, [&](float u, float v) { return u + v * p[0]; });
    case Op::weigh:
      return map2(a, b, n, out, [&](float u, float v) { return weighed(u, v, p[0], p[1]); });
    case Op::smooth_min:
      return map2(a, b, n, out, [&](float u, float v) { return least(u, v) - blend(u, v, p[0]); });
    case Op::smooth_max:
      return map2(a, b, n, out,
                  [&](float u, float v) { return greatest(u, v) + blend(u, v, p[0]); });
    case Op::curve:
      return map2(a, b, n, out, [&](float u, float v) { return curve_piece(u, v, p); });
    default:
      return one_input_row(instruction, a, n, out);
  }
}

}  // namespace

void arithmetic_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
                    OutRow out) {
  switch (instruction.op) {
    case Op::fill:
      for (std::size_t i = 0; i < n; ++i) {
        out[i] = instruction.p[0];
      }
      return;
    case Op::mix:
      return map3(a, b, c, n, out, [](float u, float v, float t) { return u + (v - u) * t; });
    case Op::multiply_add:
      return map3(a, b, c, n, out, [](float u, float v, float w) { return u + v * w; });
    case Op::select:
      return map3(a, b, c, n, out,
                  [&](float u, float v, float w) { return selected(u, v, w, instruction.p[0]); });
    case Op::blend:
      return map3(a, b, c, n, out, [&](float u, float v, float w) {
        return blended(u, v, w, instruction.p[0], instruction.p[1]);
      });
    default:
      return two_input_row(instruction, a, b, n, out);
  }
}

}  // namespace mc::graph::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
