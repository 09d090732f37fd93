// SPDX-License-Identifier: MIT
#include "pipe/vertex_materials.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

namespace mc::pipe {

namespace {

constexpr std::size_t kAtOnce = 1024;  // vertices

Affine inverse_of(const Affine& to_world) {
  const std::optional<Affine> inverse = to_world.inverse();
  if (!inverse) {
    throw Error(ErrorKind::input, "",
                "materials need a map from samples to the world that can be inverted");
  }
  return *inverse;
}

}  // namespace

VertexMaterials::VertexMaterials(const MaterialReader& materials, const Affine& to_world,
                                 const Vec3& origin)
    : materials_(materials), to_lattice_(inverse_of(to_world)), origin_(origin) {}

template <class T>
std::uint64_t VertexMaterials::give(const Buffer<T>& positions, Buffer<std::uint16_t>& out) const {
  out.resize(positions.size() / 3);
  std::array<Vec3, kAtOnce> places;
  std::uint64_t n_held = 0;
  for (std::size_t first = 0; first < out.size(); first += kAtOnce) {
    const std::size_t n = std::min(kAtOnce, out.size() - first);
    for (std::size_t v = 0; v < n; ++v) {
      const T* p = &positions[3 * (first + v)];
      places[v] = to_lattice_({p[0] + origin_[0], p[1] + origin_[1], p[2] + origin_[2]});
    }
    n_held += materials_.materials_at(std::span(places).first(n), std::span(out).subspan(first, n));
  }
  return n_held;
}

std::uint64_t VertexMaterials::give(MeshChunk& chunk) const {
  return chunk.positions_f64.empty() ? give(chunk.positions, chunk.materials)
                                     : give(chunk.positions_f64, chunk.materials);
}

}  // namespace mc::pipe
