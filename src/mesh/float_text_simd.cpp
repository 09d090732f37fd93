// SPDX-License-Identifier: MIT
#include "mesh/float_text.hpp"

// Compiles float_text-inl.hpp for every target that Highway offers and picks one at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "mesh/float_text_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "mesh/float_text-inl.hpp"

#if HWY_ONCE

namespace mc::mesh {

namespace {
HWY_EXPORT(print_floats);
}  // namespace

void print_floats(const float* x, std::size_t n, FloatText* to) {
  HWY_DYNAMIC_DISPATCH(print_floats)(x, n, to);
}

}  // namespace mc::mesh
#endif  // HWY_ONCE
