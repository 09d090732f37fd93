// SPDX-License-Identifier: MIT
#include "extract/cubes/gather_kernels.hpp"

// Compiles gather_kernels-inl.hpp for every target that Highway offers and picks one at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "extract/cubes/gather_kernels_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "extract/cubes/gather_kernels-inl.hpp"

#if HWY_ONCE
#include <cassert>

namespace mc::extraction {

namespace {
HWY_EXPORT(gather_edges);
}  // namespace

Gathered gather_edges(const PlaneSamples& planes, const EdgePlaces& edges, bool between,
                      bool gradients, const EdgeSamples& out) {
  assert(edges.n == 0 || (edges.i != nullptr && edges.j != nullptr && edges.axis != nullptr));
  assert(planes.here != nullptr && (!between || planes.after != nullptr));
  assert(!gradients || (planes.before != nullptr && planes.after != nullptr));
  assert(!gradients || !between || planes.after_next != nullptr);
  assert(planes.first[0] <= planes.lo[0] && planes.lo[0] <= planes.hi[0]);
  assert(planes.first[1] <= planes.lo[1] && planes.lo[1] <= planes.hi[1]);
  assert(out.a != nullptr && out.b != nullptr && out.failed != nullptr);
  return HWY_DYNAMIC_DISPATCH(gather_edges)(planes, edges, between, gradients, out);
}

}  // namespace mc::extraction
#endif  // HWY_ONCE
