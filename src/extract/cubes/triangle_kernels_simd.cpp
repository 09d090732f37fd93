// SPDX-License-Identifier: MIT
#include "extract/cubes/triangle_kernels.hpp"

// Compiles triangle_kernels-inl.hpp for every target that Highway offers and picks one at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "extract/cubes/triangle_kernels_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "extract/cubes/triangle_kernels-inl.hpp"

#if HWY_ONCE
#include <cassert>

namespace mc::extraction {

namespace {
HWY_EXPORT(emit_triangles);
HWY_EXPORT(count_triangles);
}  // namespace

std::size_t emit_triangles(const CellLayer& layer, std::size_t j0, std::size_t j1, bool flip,
                           std::uint32_t* out) {
  assert(same_shape(layer.lower, layer.upper));
  assert(j0 <= j1 && j1 < layer.lower.n_rows && out != nullptr);
  assert(layer.lower_ids.i != nullptr && layer.lower_ids.j != nullptr);
  assert(layer.upper_ids.i != nullptr && layer.upper_ids.j != nullptr && layer.k_ids != nullptr);
  return HWY_DYNAMIC_DISPATCH(emit_triangles)(layer, j0, j1, flip, out);
}

std::uint64_t count_triangles(const BitPlane& lower, const BitPlane& upper) {
  assert(same_shape(lower, upper));
  return HWY_DYNAMIC_DISPATCH(count_triangles)(lower, upper);
}

}  // namespace mc::extraction
#endif  // HWY_ONCE
