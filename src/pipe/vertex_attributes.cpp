// SPDX-License-Identifier: MIT
#include "pipe/vertex_attributes.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

namespace mc::pipe {

namespace {

constexpr std::size_t kAtOnce = 1024;  // vertices

Affine inverse_of(const Affine& to_world, const AttributeReader& first) {
  const std::optional<Affine> inverse = to_world.inverse();
  if (!inverse) {
    const bool is_material = first.info() == material_attribute();
    throw Error(ErrorKind::input, "",
                std::string(is_material ? "materials" : "vertex attributes") +
                    " need a map from samples to the world that can be inverted");
  }
  return *inverse;
}

}  // namespace

VertexAttributes::VertexAttributes(AttributeReaders readers, const Affine& to_world,
                                   const Vec3& origin)
    : readers_(readers), to_lattice_(inverse_of(to_world, *readers.front())), origin_(origin) {}

template <class T>
void VertexAttributes::give(const Buffer<T>& positions, MeshChunk& chunk,
                            std::vector<std::uint64_t>& n_clamped) const {
  const std::size_t n_vertices = positions.size() / 3;
  std::array<Vec3, kAtOnce> places;
  for (std::size_t first = 0; first < n_vertices; first += kAtOnce) {
    const std::size_t n = std::min(kAtOnce, n_vertices - first);
    for (std::size_t v = 0; v < n; ++v) {
      const T* p = &positions[3 * (first + v)];
      places[v] = to_lattice_({p[0] + origin_[0], p[1] + origin_[1], p[2] + origin_[2]});
    }
    for (std::size_t a = 0; a < readers_.size(); ++a) {
      VertexAttribute& to = chunk.attributes[a];
      n_clamped[a] += readers_[a]->values_at(std::span(places).first(n),
                                             to.values.data() + first * to.info.bytes());
    }
  }
}

void VertexAttributes::give(MeshChunk& chunk, std::vector<std::uint64_t>& n_clamped) const {
  n_clamped.assign(readers_.size(), 0);
  chunk.attributes.resize(readers_.size());
  for (std::size_t a = 0; a < readers_.size(); ++a) {
    VertexAttribute& attribute = chunk.attributes[a];
    if (attribute.info != readers_[a]->info()) attribute.info = readers_[a]->info();
    attribute.values.resize(chunk.n_vertices() * attribute.info.bytes());
  }
  if (chunk.positions_f64.empty()) {
    give(chunk.positions, chunk, n_clamped);
  } else {
    give(chunk.positions_f64, chunk, n_clamped);
  }
}

}  // namespace mc::pipe
