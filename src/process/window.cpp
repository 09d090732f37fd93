// SPDX-License-Identifier: MIT
#include "process/window.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "process/vertex_buffers.hpp"

// Windows are changed in place: elements only move towards the front.

namespace mc {

namespace {

constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();

/// Fills `renumbered` with the new ids, or kDropped. Returns the number of vertices that stay.
std::uint32_t renumber(std::span<const std::uint8_t> keeps, Buffer<std::uint32_t>& renumbered) {
  renumbered.resize(keeps.size());
  std::uint32_t next = 0;
  for (std::size_t v = 0; v < keeps.size(); ++v) {
    renumbered[v] = keeps[v] != 0 ? next++ : kDropped;
  }
  return next;
}

/// The range of what stays of `own`.
IndexRange kept_range(const IndexRange& own, std::span<const std::uint8_t> keeps) {
  const auto n_kept = [&](std::size_t first, std::size_t last) {
    std::size_t n = 0;
    for (std::size_t e = first; e < last; ++e) n += keeps[e] != 0 ? 1 : 0;
    return n;
  };
  const std::size_t first = n_kept(0, own.first);
  return {first, first + n_kept(own.first, own.last)};
}

void keep_vertices(MeshChunk& mesh, const Buffer<std::uint32_t>& renumbered, std::size_t n_kept) {
  process::for_vertex_buffers(mesh, [&](auto& buffer, std::size_t n) {
    if (buffer.empty()) return;
    for (std::size_t v = 0; v < renumbered.size(); ++v) {
      if (renumbered[v] == kDropped) continue;
      std::copy_n(&buffer[n * v], n, &buffer[n * renumbered[v]]);
    }
    buffer.resize(n * n_kept);
  });
}

}  // namespace

Vec3 MeshWindow::position(std::size_t vertex) const {
  const auto at = [vertex](const auto& p) {
    return Vec3{p[3 * vertex], p[3 * vertex + 1], p[3 * vertex + 2]};
  };
  return mesh.positions_f64.empty() ? at(mesh.positions) : at(mesh.positions_f64);
}

void MeshWindow::set_position(std::size_t vertex, const Vec3& position) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (mesh.positions_f64.empty()) {
      mesh.positions[3 * vertex + a] = static_cast<float>(position[a]);
    } else {
      mesh.positions_f64[3 * vertex + a] = position[a];
    }
  }
}

void MeshWindow::keep(std::span<const std::uint8_t> vertices,
                      std::span<const std::uint8_t> triangles) {
  assert(vertices.size() == n_vertices() && triangles.size() == n_triangles());
  Buffer<std::uint32_t> renumbered;
  const std::size_t n_kept = renumber(vertices, renumbered);
  own_vertices = kept_range(own_vertices, vertices);
  keep_vertices(mesh, renumbered, n_kept);
  IndexRange own;
  std::size_t n = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (t == own_triangles.first) own.first = n;
    if (t == own_triangles.last) own.last = n;
    const std::uint32_t a = renumbered[mesh.indices[3 * t]];
    const std::uint32_t b = renumbered[mesh.indices[3 * t + 1]];
    const std::uint32_t c = renumbered[mesh.indices[3 * t + 2]];
    if (triangles[t] == 0 || a == kDropped || b == kDropped || c == kDropped) continue;
    mesh.indices[3 * n] = a;
    mesh.indices[3 * n + 1] = b;
    mesh.indices[3 * n + 2] = c;
    ++n;
  }
  if (own_triangles.first == triangles.size()) own.first = n;
  if (own_triangles.last == triangles.size()) own.last = n;
  own_triangles = own;
  mesh.indices.resize(3 * n);
}

namespace process {

void drop_incomplete_triangles(MeshChunk& chunk, std::size_t first) {
  const std::size_t n_vertices = chunk.n_vertices();
  std::size_t n = first;
  for (std::size_t t = first; t < chunk.n_triangles(); ++t) {
    const auto* indices = &chunk.indices[3 * t];
    const bool complete =
        std::all_of(indices, indices + 3, [&](std::uint32_t index) { return index < n_vertices; });
    if (complete) std::copy_n(indices, 3, &chunk.indices[3 * n++]);
  }
  chunk.indices.resize(3 * n);
}

void crop_to_own(MeshWindow& window) {
  MeshChunk& mesh = window.mesh;
  const IndexRange vertices = window.own_vertices;
  const IndexRange triangles = window.own_triangles;
  for_vertex_buffers(mesh, [&](auto& buffer, std::size_t n) {
    if (buffer.empty()) return;
    std::copy_n(buffer.begin() + static_cast<std::ptrdiff_t>(n * vertices.first),
                n * vertices.size(), buffer.begin());
    buffer.resize(n * vertices.size());
  });
  for (std::size_t i = 0; i < 3 * triangles.size(); ++i) {
    assert(mesh.indices[3 * triangles.first + i] >= vertices.first);
    mesh.indices[i] =
        mesh.indices[3 * triangles.first + i] - static_cast<std::uint32_t>(vertices.first);
  }
  mesh.indices.resize(3 * triangles.size());
  window.own_vertices = {0, vertices.size()};
  window.own_triangles = {0, triangles.size()};
}

}  // namespace process

}  // namespace mc
