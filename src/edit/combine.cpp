// SPDX-License-Identifier: MIT
#include "edit/combine.hpp"

#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "field/visit_type.hpp"

// Arithmetic on samples: in double, rounded to the samples' type at the end of each step.

namespace mc::edit {

namespace {

/// To the nearest integer, ties to even; saturates. Some integer for NaN, which no sample takes.
template <class T>
T rounded(double v) {
  using Limits = std::numeric_limits<T>;
  constexpr auto kLo = static_cast<double>(Limits::min());
  constexpr auto kHi = static_cast<double>(Limits::max());
  if constexpr (sizeof(T) < sizeof(double)) {
    constexpr double kWhole = 0x1.8p52;  // adding it leaves no bits for a fraction
    const double below = v < kHi ? v : kHi;
    const double held = below > kLo ? below : kLo;
    return static_cast<T>((held + kWhole) - kWhole);
  } else {
    if (!(v < kHi)) return Limits::max();  // kHi is 2^63
    return v <= kLo ? Limits::min() : static_cast<T>(__builtin_nearbyint(v));
  }
}

template <class T>
T narrowed(double v) {
  if constexpr (std::is_same_v<T, Half>) {
    return to_half(static_cast<float>(v));
  } else if constexpr (std::is_integral_v<T>) {
    return rounded<T>(v);
  } else {
    return static_cast<T>(v);
  }
}

template <class T>
double widened(T v) {
  return static_cast<double>(field::number(v));
}

/// d + (b - d) t; b from t = 1 on. An infinite d has no way to go until then.
double mixed(double d, double b, double t) {
  const double between = std::abs(d) <= std::numeric_limits<double>::max() ? d + (b - d) * t : d;
  return t >= 1 ? b : between;
}

/// How much the corner of a minimum is cut: h h k / 4.
double corner(double a, double b, double k) {
  if (!(k > 0)) return 0;
  const double near = k - std::abs(a - b);
  const double h = (near > 0 ? near : 0) / k;
  return h * h * k / 4;
}

/// Changes the rows that are reached: f(d, w, b) is the new value.
template <class T, class F>
void change(std::uint32_t steps, const BlockWeights& weights, const double* operand, T* samples,
            F f) {
  for_rows_of(weights.reached, [&](std::size_t row) {
    const double* w = weights.weight.data() + row * kBlockSize;
    const double* b = operand + row * kBlockSize;
    T* d = samples + row * kBlockSize;
    for (std::uint32_t step = 0; step < steps; ++step) {
      for (std::size_t i = 0; i < kBlockSize; ++i) {
        const double before = widened(d[i]);
        const double value = f(before, w[i], b[i]);
        const T next = narrowed<T>(value);
        d[i] = w[i] > 0 && before == before && value == value ? next : d[i];
      }
    }
  });
}

template <class T>
void combine_as(const Recipe& r, const BlockWeights& weights, const double* operand, T* samples) {
  const double s = r.amount;
  switch (r.rule) {
    case Rule::add:
      return change(r.steps, weights, operand, samples, [&](double d, double w, double b) {
        const double sum = d + (s * w) * b;
        const double raised = sum < r.clamp[0] ? r.clamp[0] : sum;
        return raised > r.clamp[1] ? r.clamp[1] : raised;
      });
    case Rule::mix:
      return change(r.steps, weights, operand, samples,
                    [&](double d, double w, double b) { return mixed(d, b, s * w); });
    case Rule::greatest:
      return change(r.steps, weights, operand, samples, [&](double d, double w, double b) {
        return mixed(d, (b > d ? b : d) + corner(d, b, r.smooth), s * w);
      });
    case Rule::least:
      return change(r.steps, weights, operand, samples, [&](double d, double w, double b) {
        return mixed(d, (b < d ? b : d) - corner(d, b, r.smooth), s * w);
      });
  }
}

}  // namespace

Recipe recipe_of(const Edit& edit, const EditRules& rules) {
  Recipe out;
  out.steps = edit.steps;
  out.clamp = edit.clamp;
  out.smooth = edit.smooth;
  const bool less = edit.op == EditOp::subtract || (edit.op == EditOp::stamp && edit.stamp_carves);
  const bool up = rules.above != less;  // whether values rise
  switch (edit.op) {
    case EditOp::add:
    case EditOp::subtract:
    case EditOp::stamp:
      if (edit.blend == Blend::csg) {
        out.rule = up ? Rule::greatest : Rule::least;
        out.amount = edit.strength;
        return out;
      }
      [[fallthrough]];
    case EditOp::inflate:
    case EditOp::noise:
      out.amount = up ? edit.strength : -edit.strength;
      return out;
    default:
      out.rule = Rule::mix;
      out.amount = edit.strength;
      return out;
  }
}

void combine(const Recipe& recipe, const BlockWeights& weights,
             std::span<const double, kBlockSamples> operand, SampleType type, std::byte* samples) {
  field::visit_type(type, [&]<class T>(field::TypeTag<T>) {
    combine_as(recipe, weights, operand.data(), reinterpret_cast<T*>(samples));
  });
}

Mask512 restore(double amount, std::uint32_t steps, const BlockWeights& weights, SampleType type,
                const std::byte* from, std::byte* samples) {
  Mask512 whole{};
  field::visit_type(type, [&]<class T>(field::TypeTag<T>) {
    const auto* input = reinterpret_cast<const T*>(from);
    auto* out = reinterpret_cast<T*>(samples);
    std::array<double, kBlockSamples> target;
    to_doubles(type, {from, kBlockSamples * sizeof(T)}, target.data());
    change(steps, weights, target.data(), out,
           [&](double d, double w, double b) { return mixed(d, b, amount * w); });
    for_rows_of(weights.reached, [&](std::size_t row) {
      for (std::size_t i = 0; i < kBlockSize; ++i) {
        const std::size_t n = row * kBlockSize + i;
        if (!(amount * weights.weight[n] >= 1)) continue;
        out[n] = input[n];
        whole[row / kBlockSize] |= std::uint64_t{1} << (row % kBlockSize * kBlockSize + i);
      }
    });
  });
  return whole;
}

Scalar sample_of(double value, SampleType type) {
  return field::visit_type(
      type, [&]<class T>(field::TypeTag<T>) { return Scalar::of(narrowed<T>(value)); });
}

void to_doubles(SampleType type, std::span<const std::byte> samples, double* out) {
  field::visit_type(type, [&]<class T>(field::TypeTag<T>) {
    for (std::size_t n = 0; n * sizeof(T) < samples.size(); ++n) {
      out[n] = widened(field::load_sample<T, false>(samples.data() + n * sizeof(T)));
    }
  });
}

}  // namespace mc::edit
