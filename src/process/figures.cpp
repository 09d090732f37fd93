// SPDX-License-Identifier: MIT
#include "process/figures.hpp"

#include <algorithm>
#include <vector>

#include "base/vectors.hpp"

namespace mc::process {

namespace {

template <class T>
void include_all(const Buffer<T>& positions, Bounds& bounds) {
  for (std::size_t n = 0; n < positions.size(); n += 3) {
    bounds.include(Vec3{positions[n], positions[n + 1], positions[n + 2]});
  }
}

/// Calls visit(lower, upper) for the vertices of each side whose lower vertex is the window's own,
/// counted from the first own vertex.
template <class Visit>
void for_own_sides(const MeshWindow& window, Visit&& visit) {
  const IndexRange& own = window.own_vertices;
  for (std::size_t n = 0; n < window.mesh.indices.size(); n += 3) {
    const std::uint32_t* corner = &window.mesh.indices[n];
    for (std::size_t s = 0; s < 3; ++s) {
      const auto [lower, upper] = std::minmax(corner[s], corner[(s + 1) % 3]);
      if (own.first <= lower && lower < own.last) visit(lower - own.first, upper);
    }
  }
}

std::uint64_t n_single(std::vector<std::uint32_t>::iterator first,
                       std::vector<std::uint32_t>::iterator last) {
  std::sort(first, last);
  std::uint64_t n = 0;
  while (first != last) {
    const auto next = std::upper_bound(first, last, *first);
    n += next - first == 1 ? 1 : 0;
    first = next;
  }
  return n;
}

}  // namespace

Bounds bounds_of(const MeshChunk& mesh) {
  Bounds bounds;
  include_all(mesh.positions, bounds);
  include_all(mesh.positions_f64, bounds);
  return bounds;
}

SurfaceSums own_sums(const MeshWindow& window, const Vec3& apex) {
  SurfaceSums sums;
  for (std::size_t t = window.own_triangles.first; t < window.own_triangles.last; ++t) {
    const Vec3 a = window.position(window.mesh.indices[3 * t]);
    const Vec3 b = window.position(window.mesh.indices[3 * t + 1]);
    const Vec3 c = window.position(window.mesh.indices[3 * t + 2]);
    const Vec3 normal = cross(minus(b, a), minus(c, a));
    sums.area.add(0.5 * length(normal));
    sums.volume.add(dot(minus(a, apex), normal) / 6);
  }
  return sums;
}

std::uint64_t own_boundary_edges(const MeshWindow& window) {
  // The upper vertices of all sides, sorted by the lower vertex: behind those of vertex v are those
  // of v + 1.
  std::vector<std::size_t> ends(window.own_vertices.size() + 1);
  for_own_sides(window, [&](std::size_t lower, std::uint32_t /*upper*/) { ++ends[lower + 1]; });
  for (std::size_t v = 1; v < ends.size(); ++v) ends[v] += ends[v - 1];
  std::vector<std::uint32_t> uppers(ends.back());
  for_own_sides(window,
                [&](std::size_t lower, std::uint32_t upper) { uppers[ends[lower]++] = upper; });
  std::uint64_t n = 0;
  auto first = uppers.begin();
  for (std::size_t v = 0; v + 1 < ends.size(); ++v) {
    const auto last = uppers.begin() + static_cast<std::ptrdiff_t>(ends[v]);
    n += n_single(first, last);
    first = last;
  }
  return n;
}

}  // namespace mc::process
