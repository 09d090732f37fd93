// SPDX-License-Identifier: MIT
#include "extract/sparse/block_kernels.hpp"

// Compiles block_kernels-inl.hpp for every target that Highway offers and picks one at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "extract/sparse/block_kernels_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "extract/sparse/block_kernels-inl.hpp"

#if HWY_ONCE
#include <algorithm>
#include <cassert>

namespace mc::extraction {

namespace {
HWY_EXPORT(planes_of);
HWY_EXPORT(find_edges);
HWY_EXPORT(find_cells);
HWY_EXPORT(count_block_triangles);
HWY_EXPORT(list_edges);
HWY_EXPORT(enter_ids);
HWY_EXPORT(emit_block);

[[maybe_unused]] bool is_whole(const BlockBits& bits) {
  return std::ranges::all_of(bits, [](const Mask512* mask) { return mask != nullptr; });
}
}  // namespace

Mask512 planes_of(const Mask512& x_slices) { return HWY_DYNAMIC_DISPATCH(planes_of)(x_slices); }

BlockEdges find_edges(const BlockBits& above, const BlockBits* exists) {
  assert(is_whole(above) && (exists == nullptr || is_whole(*exists)));
  return HWY_DYNAMIC_DISPATCH(find_edges)(above, exists);
}

Mask512 find_cells(const BlockBits& above, const BlockBits* exists) {
  assert(is_whole(above) && (exists == nullptr || is_whole(*exists)));
  return HWY_DYNAMIC_DISPATCH(find_cells)(above, exists);
}

std::uint32_t count_block_triangles(const BlockBits& above, const Mask512& cells) {
  assert(is_whole(above));
  return HWY_DYNAMIC_DISPATCH(count_block_triangles)(above, cells);
}

std::size_t list_edges(const BlockEdges& edges, std::uint16_t* out) {
  assert(edges.n_vertices <= kBlockEdges && out != nullptr);
  return HWY_DYNAMIC_DISPATCH(list_edges)(edges, out);
}

void enter_ids(std::size_t neighbour, const BlockEdges& edges, std::uint32_t first,
               IdTable& table) {
  assert(neighbour >= 1 && neighbour <= 7);
  HWY_DYNAMIC_DISPATCH(enter_ids)(neighbour, edges, first, table);
}

std::size_t emit_block(const BlockBits& above, const Mask512& cells, const IdTable& table,
                       bool flip, std::uint32_t* out) {
  assert(is_whole(above) && out != nullptr);
  return HWY_DYNAMIC_DISPATCH(emit_block)(above, cells, table, flip, out);
}

}  // namespace mc::extraction
#endif  // HWY_ONCE
