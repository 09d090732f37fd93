// SPDX-License-Identifier: MIT
#include "mesh/word_kernels.hpp"

// Compiles word_kernels-inl.hpp for every target that Highway offers and picks one at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "mesh/word_kernels_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "mesh/word_kernels-inl.hpp"

#if HWY_ONCE

namespace mc::mesh {

namespace {
HWY_EXPORT(move_words);
}  // namespace

void move_words(const void* from, std::size_t n, std::uint32_t add, void* to, Stores stores) {
  HWY_DYNAMIC_DISPATCH(move_words)(from, n, add, to, stores);
}

}  // namespace mc::mesh
#endif  // HWY_ONCE
