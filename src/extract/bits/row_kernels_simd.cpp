// SPDX-License-Identifier: MIT
#include "extract/bits/row_kernels.hpp"

// Compiles row_kernels-inl.hpp for every target that Highway offers and picks one at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "extract/bits/row_kernels_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "extract/bits/row_kernels-inl.hpp"

#if HWY_ONCE
#include <cassert>

namespace mc::extraction {

namespace {
HWY_EXPORT(number_plane);
HWY_EXPORT(number_between);
HWY_EXPORT(list_plane);
HWY_EXPORT(list_between);
HWY_EXPORT(count_face_sides);
}  // namespace

std::uint32_t number_plane(const BitPlane& plane, std::uint32_t next, const PlaneIds& ids) {
  assert(is_padded(plane) && ids.i != nullptr && ids.j != nullptr);
  return HWY_DYNAMIC_DISPATCH(number_plane)(plane, next, ids);
}

std::uint32_t number_between(const BitPlane& lower, const BitPlane& upper, std::uint32_t next,
                             std::uint32_t* k_ids) {
  assert(same_shape(lower, upper) && k_ids != nullptr);
  return HWY_DYNAMIC_DISPATCH(number_between)(lower, upper, next, k_ids);
}

std::size_t list_plane(const BitPlane& plane, std::size_t j, std::size_t j_end, std::uint32_t& next,
                       const PlaneIds& ids, EdgeList& out) {
  assert(is_padded(plane) && j <= j_end && j_end <= plane.n_rows);
  assert(ids.i != nullptr && ids.j != nullptr);
  assert(out.room >= list_room(plane.n_samples));
  return HWY_DYNAMIC_DISPATCH(list_plane)(plane, j, j_end, next, ids, out);
}

std::size_t list_between(const BitPlane& lower, const BitPlane& upper, std::size_t j,
                         std::size_t j_end, std::uint32_t& next, std::uint32_t* k_ids,
                         EdgeList& out) {
  assert(same_shape(lower, upper) && j <= j_end && j_end <= lower.n_rows && k_ids != nullptr);
  assert(out.room >= list_room(lower.n_samples));
  return HWY_DYNAMIC_DISPATCH(list_between)(lower, upper, j, j_end, next, k_ids, out);
}

std::uint64_t count_face_sides(const std::uint64_t* a, const std::uint64_t* b,
                               const std::uint64_t* cells, std::size_t n_words) {
  assert(n_words == 0 || (a != nullptr && b != nullptr && cells != nullptr));
  return HWY_DYNAMIC_DISPATCH(count_face_sides)(a, b, cells, n_words);
}

}  // namespace mc::extraction
#endif  // HWY_ONCE
