// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "mc/field.hpp"

namespace mc::mesh {

/// Characters that a number of an attribute takes as text, with a space before it: at most, but of
/// floating-point numbers what is usual.
constexpr std::size_t usual_digits(SampleType type) {
  switch (type) {
    case SampleType::u8:
    case SampleType::i8:
      return 5;
    case SampleType::u16:
    case SampleType::i16:
      return 7;
    case SampleType::u32:
    case SampleType::i32:
      return 12;
    case SampleType::f16:
    case SampleType::f32:
      return 16;
    case SampleType::i64:
    case SampleType::f64:
      return 25;
  }
  return 25;
}

}  // namespace mc::mesh
