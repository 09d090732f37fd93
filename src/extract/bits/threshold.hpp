// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "field/visit_type.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"

// The one predicate of the program: is a sample above? When the solid is above, value >= iso; when
// it is below, !(value < iso). The same for all numbers, so a sample equal to iso is above either
// way, and NaN is never solid.

namespace mc::extraction {

/// The predicate in a sample type. Integers compare with ceil(iso); f16 and f32 with iso rounded to
/// float.
struct Threshold {
  SampleType type = SampleType::f32;
  bool swap = false;        ///< samples are not in native byte order
  bool nan_above = false;   ///< what a NaN is: above where the solid is below
  bool none_above = false;  ///< iso lies past the largest integer
  Scalar level;             ///< in the sample type; float for f16

  Threshold() = default;
  Threshold(SampleType sample_type, std::endian endian, double iso, Inside inside);
};

/// The type a sample is compared and interpolated in before rounding: Half as float.
template <class T>
using Number = decltype(field::number(T{}));

/// iso as it is used with this type: rounded to float for f16 and f32.
inline double effective_iso(SampleType type, double iso) {
  const bool rounded = type == SampleType::f16 || type == SampleType::f32;
  return rounded ? static_cast<double>(static_cast<float>(iso)) : iso;
}

template <class T>
inline bool is_above(T sample, const Threshold& threshold) {
  const auto value = field::number(sample);
  const auto level = threshold.level.as<Number<T>>();
  if constexpr (std::is_floating_point_v<Number<T>>) {
    return threshold.nan_above ? !(value < level) : value >= level;
  } else {
    return !threshold.none_above && value >= level;
  }
}

}  // namespace mc::extraction
