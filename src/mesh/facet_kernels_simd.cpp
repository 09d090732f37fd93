// SPDX-License-Identifier: MIT
#include "mesh/facet_kernels.hpp"

// Compiles facet_kernels-inl.hpp for every target that Highway offers and picks one at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "mesh/facet_kernels_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "mesh/facet_kernels-inl.hpp"

#if HWY_ONCE

namespace mc::mesh {

namespace {
HWY_EXPORT(compute_normals);
}  // namespace

void compute_normals(FacetBlock& block) { HWY_DYNAMIC_DISPATCH(compute_normals)(block); }

}  // namespace mc::mesh
#endif  // HWY_ONCE
