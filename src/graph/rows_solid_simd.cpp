// SPDX-License-Identifier: MIT
#include "graph/rows.hpp"

// Compiles rows_solid-inl.hpp for every target that Highway offers and picks one at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "graph/rows_solid_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "graph/rows_solid-inl.hpp"

#if HWY_ONCE
namespace mc::graph {

namespace {
HWY_EXPORT(solid_row);
}  // namespace

void solid_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
               OutRow out) noexcept {
  HWY_DYNAMIC_DISPATCH(solid_row)(instruction, a, b, c, n, out);
}

}  // namespace mc::graph
#endif  // HWY_ONCE
