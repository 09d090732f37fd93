// SPDX-License-Identifier: MIT
#include "extract/cubes/vertex_kernels.hpp"

// Compiles vertex_kernels-inl.hpp for every target that Highway offers and picks one at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "extract/cubes/vertex_kernels_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "extract/cubes/vertex_kernels-inl.hpp"

#if HWY_ONCE
#include <algorithm>
#include <cassert>

namespace mc::extraction {

namespace {
HWY_EXPORT(cut_f32);
HWY_EXPORT(cut_f64);
HWY_EXPORT(place_f32_f32);
HWY_EXPORT(place_f32_f64);
HWY_EXPORT(place_f64_f32);
HWY_EXPORT(place_f64_f64);
HWY_EXPORT(orient_f32);
HWY_EXPORT(orient_f64);

template <class R>
[[maybe_unused]] bool is_whole(const EdgePlaces& edges, const R* t) {
  return edges.n == 0 || (edges.i != nullptr && edges.j != nullptr && edges.k != nullptr &&
                          edges.axis != nullptr && t != nullptr);
}
template <class R>
[[maybe_unused]] bool is_whole(const EdgeGradients<R>& g) {
  const auto given = [](const R* p) { return p != nullptr; };
  return std::ranges::all_of(g.lower, given) && std::ranges::all_of(g.upper, given);
}
template <class R>
[[maybe_unused]] bool is_valid(const EdgeRule<R>& rule) {
  return rule.low >= 0 && rule.low <= rule.high && rule.high <= 1 && rule.cutoff >= 0;
}
}  // namespace

void cut_edges(const EdgeRule<float>& rule, const float* a, const float* b, std::size_t n,
               float* t) {
  assert(is_valid(rule) && (n == 0 || (a != nullptr && b != nullptr && t != nullptr)));
  HWY_DYNAMIC_DISPATCH(cut_f32)(rule, a, b, n, t);
}
void cut_edges(const EdgeRule<double>& rule, const double* a, const double* b, std::size_t n,
               double* t) {
  assert(is_valid(rule) && (n == 0 || (a != nullptr && b != nullptr && t != nullptr)));
  HWY_DYNAMIC_DISPATCH(cut_f64)(rule, a, b, n, t);
}

void place_vertices(const EdgePlaces& edges, const float* t, const Affine& map, float* out,
                    Bounds& bounds) {
  assert(is_whole(edges, t) && (edges.n == 0 || out != nullptr));
  HWY_DYNAMIC_DISPATCH(place_f32_f32)(edges, t, map, out, bounds);
}
void place_vertices(const EdgePlaces& edges, const float* t, const Affine& map, double* out,
                    Bounds& bounds) {
  assert(is_whole(edges, t) && (edges.n == 0 || out != nullptr));
  HWY_DYNAMIC_DISPATCH(place_f32_f64)(edges, t, map, out, bounds);
}
void place_vertices(const EdgePlaces& edges, const double* t, const Affine& map, float* out,
                    Bounds& bounds) {
  assert(is_whole(edges, t) && (edges.n == 0 || out != nullptr));
  HWY_DYNAMIC_DISPATCH(place_f64_f32)(edges, t, map, out, bounds);
}
void place_vertices(const EdgePlaces& edges, const double* t, const Affine& map, double* out,
                    Bounds& bounds) {
  assert(is_whole(edges, t) && (edges.n == 0 || out != nullptr));
  HWY_DYNAMIC_DISPATCH(place_f64_f64)(edges, t, map, out, bounds);
}

std::size_t orient_vertices(const EdgeGradients<float>& gradients, const float* t, std::size_t n,
                            const std::array<double, 9>& turn, float* out, std::uint32_t* failed) {
  assert(n == 0 || (is_whole(gradients) && t != nullptr && out != nullptr && failed != nullptr));
  return HWY_DYNAMIC_DISPATCH(orient_f32)(gradients, t, n, turn, out, failed);
}
std::size_t orient_vertices(const EdgeGradients<double>& gradients, const double* t, std::size_t n,
                            const std::array<double, 9>& turn, float* out, std::uint32_t* failed) {
  assert(n == 0 || (is_whole(gradients) && t != nullptr && out != nullptr && failed != nullptr));
  return HWY_DYNAMIC_DISPATCH(orient_f64)(gradients, t, n, turn, out, failed);
}

}  // namespace mc::extraction
#endif  // HWY_ONCE
