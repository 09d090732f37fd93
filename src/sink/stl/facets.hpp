// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "mc/base.hpp"
#include "mesh/facet_kernels.hpp"
#include "sink/records.hpp"
#include "sink/text.hpp"

// Facets of STL in both forms, made of three positions each.

namespace mc::sink {

constexpr std::size_t kFacetBytes = 50;  // normal, three positions, two bytes of attributes

using Ids = std::array<std::uint32_t, 3>;

/// The normals of triangles, made block by block: position_of(id) points to three floats. They are
/// unit vectors by the right hand, and zero where a facet has no area or is not finite.
template <class PositionOf>
class FacetNormals {
 public:
  FacetNormals(std::span<const Ids> triangles, PositionOf position_of)
      : triangles_(triangles), position_of_(position_of) {}

  /// That of triangle n; to be asked for in order, from 0 on.
  std::array<float, 3> operator()(std::size_t n) {
    if (n % mesh::kFacetBlock == 0) start_block(n);
    const std::size_t i = n % mesh::kFacetBlock;
    return {block_.normal[0][i], block_.normal[1][i], block_.normal[2][i]};
  }

 private:
  void start_block(std::size_t first) {
    const std::size_t n = std::min(mesh::kFacetBlock, triangles_.size() - first);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        const float* const p = position_of_(triangles_[first + i][c]);
        for (std::size_t a = 0; a < 3; ++a) block_.corner[3 * c + a][i] = p[a];
      }
    }
    mesh::compute_normals(block_);
  }

  std::span<const Ids> triangles_;
  PositionOf position_of_;
  mesh::FacetBlock block_{};
};

/// Makes the facets of triangles from `at` on.
template <class PositionOf>
void encode_facets(std::span<const Ids> triangles, std::byte* at, PositionOf position_of) {
  constexpr std::size_t kTriple = 3 * sizeof(float);
  FacetNormals<PositionOf> normal_of(triangles, position_of);
  for (std::size_t n = 0; n < triangles.size(); ++n, at += kFacetBytes) {
    const std::array<float, 3> normal = normal_of(n);
    for (std::size_t a = 0; a < 3; ++a)
      std::memcpy(at + a * sizeof(float), &normal[a], sizeof(float));
    for (std::size_t c = 0; c < 3; ++c) {
      std::memcpy(at + (1 + c) * kTriple, position_of(triangles[n][c]), kTriple);
    }
    std::memset(at + 4 * kTriple, 0, kFacetBytes - 4 * kTriple);
  }
}

/// The same in the text form, into `to`.
template <class PositionOf>
void print_facets(std::span<const Ids> triangles, Buffer<std::byte>& to, PositionOf position_of) {
  constexpr LineBytes kFacet{100 + 4 * kMostTriple, 100 + 4 * kFloatTriple};
  FacetNormals<PositionOf> normal_of(triangles, position_of);
  make_lines(triangles.size(), kFacet, to, [&](std::size_t n, char* at) {
    at = print_triple(print_text(at, "facet normal "), normal_of(n).data());
    at = print_text(at, "\n outer loop\n");
    for (const std::uint32_t id : triangles[n]) {
      at = print_triple(print_text(at, "  vertex "), position_of(id));
      *at++ = '\n';
    }
    return print_text(at, " endloop\nendfacet\n");
  });
}

}  // namespace mc::sink
