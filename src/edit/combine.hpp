// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "edit/block_weights.hpp"
#include "mc/edit.hpp"

namespace mc::edit {

/// How a sample d, its weight w and its operand b make the new sample.
enum class Rule : std::uint8_t {
  add,       ///< clamp(d + (amount w) b)
  mix,       ///< mix(d, b, amount w)
  greatest,  ///< mix(d, max(d, b), amount w), the corner rounded by `smooth`
  least,     ///< mix(d, min(d, b), amount w), likewise
};

struct Recipe {
  Rule rule = Rule::add;
  double amount = 0;
  double smooth = 0;
  std::array<double, 2> clamp{};  ///< add
  std::uint32_t steps = 1;        ///< so often; each step ends with rounding to the samples' type
};

/// What an edit's operation comes down to.
Recipe recipe_of(const Edit& edit, const EditRules& rules);

/// Changes the samples that are reached. mix(d, b, t) = d + (b - d) t, and b where t >= 1. A sample
/// that is NaN stays, and so does one that would become NaN. Integers are rounded to nearest, ties
/// to even, and saturate; f16 is rounded to f32 first.
void combine(const Recipe& recipe, const BlockWeights& weights,
             std::span<const double, kBlockSamples> operand, SampleType type, std::byte* samples);

/// Puts the samples of `from` where their part reaches 1, and else mixes: as Rule::mix, but for
/// samples of any bits. Returns those that were put.
Mask512 restore(double amount, std::uint32_t steps, const BlockWeights& weights, SampleType type,
                const std::byte* from, std::byte* samples);

/// A number as a sample: rounded, integers to nearest even and saturated.
[[nodiscard]] Scalar sample_of(double value, SampleType type);

/// All samples as numbers.
void to_doubles(SampleType type, std::span<const std::byte> samples, double* out);

}  // namespace mc::edit
