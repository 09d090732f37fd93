// SPDX-License-Identifier: MIT
#include "extract/cubes/triangle_kernels.hpp"

// Compiles triangle_kernels-inl.hpp for every target that Highway offers and picks one at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "extract/cubes/triangle_kernels_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "extract/cubes/triangle_kernels-inl.hpp"

#if HWY_ONCE
namespace mc::extraction {

namespace {
HWY_EXPORT(emit_triangles);
HWY_EXPORT(count_triangles);
}  // namespace

std::size_t emit_triangles(const CellLayer& layer, std::size_t j0, std::size_t j1, bool flip,
                           std::uint32_t* out) {
  return HWY_DYNAMIC_DISPATCH(emit_triangles)(layer, j0, j1, flip, out);
}

std::uint64_t count_triangles(const BitPlane& lower, const BitPlane& upper) {
  return HWY_DYNAMIC_DISPATCH(count_triangles)(lower, upper);
}

}  // namespace mc::extraction
#endif  // HWY_ONCE
