// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "extract/cubes/edge_vertex.hpp"
#include "mc/mesh.hpp"

// The geometry of edge_vertex.hpp for many edges at once, in the same arithmetic and so to the same
// bits. Compiled for every SIMD target and chosen at run time. Arrays can be read and written up to
// the next multiple of kEdgesAtOnce; what is read there repeats the last edge.

namespace mc::extraction {

inline constexpr std::size_t kEdgesAtOnce = 16;

/// Crossed edges, structure of arrays: the lattice indices of the lower sample, and the axis.
struct EdgePlaces {
  const std::int32_t* i = nullptr;
  const std::int32_t* j = nullptr;
  const std::int32_t* k = nullptr;
  const std::int32_t* axis = nullptr;
  std::size_t n = 0;
};

/// EdgeRule::parameter() of samples a (lower) and b.
void cut_edges(const EdgeRule<float>& rule, const float* a, const float* b, std::size_t n,
               float* t);
void cut_edges(const EdgeRule<double>& rule, const double* a, const double* b, std::size_t n,
               double* t);

/// Placement::position(), rounded; three numbers each. Adds what was written to `bounds`.
void place_vertices(const EdgePlaces& edges, const float* t, const Affine& map, float* out,
                    Bounds& bounds);
void place_vertices(const EdgePlaces& edges, const float* t, const Affine& map, double* out,
                    Bounds& bounds);
void place_vertices(const EdgePlaces& edges, const double* t, const Affine& map, float* out,
                    Bounds& bounds);
void place_vertices(const EdgePlaces& edges, const double* t, const Affine& map, double* out,
                    Bounds& bounds);

/// Gradients at both ends of edges, per step of the lattice.
template <class R>
struct EdgeGradients {
  std::array<const R*, 3> lower{}, upper{};
};

/// Unit normals by the gradient at the vertex; three numbers each. `turn` maps covectors, and the
/// sign that makes them point out of the solid, into the world. Writes the numbers of those whose
/// gradient is zero, not finite, or too long or short to be squared, and returns how many.
std::size_t orient_vertices(const EdgeGradients<float>& gradients, const float* t, std::size_t n,
                            const std::array<double, 9>& turn, float* out, std::uint32_t* failed);
std::size_t orient_vertices(const EdgeGradients<double>& gradients, const double* t, std::size_t n,
                            const std::array<double, 9>& turn, float* out, std::uint32_t* failed);

}  // namespace mc::extraction
