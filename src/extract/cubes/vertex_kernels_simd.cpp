// SPDX-License-Identifier: MIT
#include "extract/cubes/vertex_kernels.hpp"

// Compiles vertex_kernels-inl.hpp for every target that Highway offers and picks one at run time.

#undef HWY_TARGET_INCLUDE
#define HWY_WANT_AVX3_DL 1
#define HWY_TARGET_INCLUDE "extract/cubes/vertex_kernels_simd.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h

#include "extract/cubes/vertex_kernels-inl.hpp"

#if HWY_ONCE
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
}  // namespace

void cut_edges(const EdgeRule<float>& rule, const float* a, const float* b, std::size_t n,
               float* t) {
  HWY_DYNAMIC_DISPATCH(cut_f32)(rule, a, b, n, t);
}
void cut_edges(const EdgeRule<double>& rule, const double* a, const double* b, std::size_t n,
               double* t) {
  HWY_DYNAMIC_DISPATCH(cut_f64)(rule, a, b, n, t);
}

void place_vertices(const EdgePlaces& edges, const float* t, const Affine& map, float* out,
                    Bounds& bounds) {
  HWY_DYNAMIC_DISPATCH(place_f32_f32)(edges, t, map, out, bounds);
}
void place_vertices(const EdgePlaces& edges, const float* t, const Affine& map, double* out,
                    Bounds& bounds) {
  HWY_DYNAMIC_DISPATCH(place_f32_f64)(edges, t, map, out, bounds);
}
void place_vertices(const EdgePlaces& edges, const double* t, const Affine& map, float* out,
                    Bounds& bounds) {
  HWY_DYNAMIC_DISPATCH(place_f64_f32)(edges, t, map, out, bounds);
}
void place_vertices(const EdgePlaces& edges, const double* t, const Affine& map, double* out,
                    Bounds& bounds) {
  HWY_DYNAMIC_DISPATCH(place_f64_f64)(edges, t, map, out, bounds);
}

std::size_t orient_vertices(const EdgeGradients<float>& gradients, const float* t, std::size_t n,
                            const std::array<double, 9>& turn, float* out, std::uint32_t* failed) {
  return HWY_DYNAMIC_DISPATCH(orient_f32)(gradients, t, n, turn, out, failed);
}
std::size_t orient_vertices(const EdgeGradients<double>& gradients, const double* t, std::size_t n,
                            const std::array<double, 9>& turn, float* out, std::uint32_t* failed) {
  return HWY_DYNAMIC_DISPATCH(orient_f64)(gradients, t, n, turn, out, failed);
}

}  // namespace mc::extraction
#endif  // HWY_ONCE
