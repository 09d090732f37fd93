// SPDX-License-Identifier: MIT
#include "extract/cubes/gather_kernels.hpp"

// Compiles gather_kernels-inl.hpp for every target that Highway offers and picks one at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "extract/cubes/gather_kernels_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "extract/cubes/gather_kernels-inl.hpp"

#if HWY_ONCE
namespace mc::extraction {

namespace {
HWY_EXPORT(gather_edges);
}  // namespace

Gathered gather_edges(const PlaneSamples& planes, const EdgePlaces& edges, bool between,
                      bool gradients, const EdgeSamples& out) {
  return HWY_DYNAMIC_DISPATCH(gather_edges)(planes, edges, between, gradients, out);
}

}  // namespace mc::extraction
#endif  // HWY_ONCE
