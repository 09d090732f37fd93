// SPDX-License-Identifier: MIT
#include "extract/bits/threshold.hpp"

#include <cassert>

namespace mc::extraction {

namespace {

/// ceil(iso) in T. Below the range: the lowest value, which all samples reach. Above: none does.
template <class T>
void set_integer_level(Threshold& t, double iso) {
  using Limits = std::numeric_limits<T>;
  const double level = std::ceil(iso);
  // 2^bits is exact in double where the largest value may not be.
  const double past_max = std::ldexp(1.0, Limits::digits);
  t.none_above = level >= past_max;
  const bool below_min = level <= static_cast<double>(Limits::min());
  t.level = Scalar::of<T>(t.none_above ? Limits::max()
                          : below_min  ? Limits::min()
                                       : static_cast<T>(level));
}

}  // namespace

Threshold::Threshold(SampleType sample_type, std::endian endian, double iso, Inside inside)
    : type(sample_type),
      swap(endian != std::endian::native && sample_size(sample_type) > 1),
      nan_above(inside == Inside::below) {
  assert(std::isfinite(iso));
  field::visit_type(type, [&]<class T>(field::TypeTag<T> /*tag*/) {
    if constexpr (std::is_integral_v<T>) {
      set_integer_level<T>(*this, iso);
    } else {
      level = Scalar::of(static_cast<Number<T>>(iso));
    }
  });
}

}  // namespace mc::extraction
