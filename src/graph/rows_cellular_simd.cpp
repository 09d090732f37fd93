// SPDX-License-Identifier: MIT
#include "graph/rows.hpp"

// Compiles rows_cellular-inl.hpp for every target that Highway offers and picks one at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "graph/rows_cellular_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "graph/rows_cellular-inl.hpp"

#if HWY_ONCE
namespace mc::graph {

namespace {
HWY_EXPORT(cellular_row);
}  // namespace

void cellular_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
                  OutRow out) noexcept {
  HWY_DYNAMIC_DISPATCH(cellular_row)(instruction, a, b, c, n, out);
}

}  // namespace mc::graph
#endif  // HWY_ONCE
