// SPDX-License-Identifier: MIT
#include "mesh/memory_sink.hpp"

#include <algorithm>
#include <limits>
#include <mutex>

#include "mesh/word_kernels.hpp"

// place() makes room, write() fills it: only a mesh that must move to larger memory keeps a thread
// from its copying, and one that was as large before does not move.

namespace mc::mesh {

namespace {

/// A mesh of more bytes than a core's own cache would only push out what the cores work on.
constexpr std::size_t kStreamedBytes = std::size_t{8} << 20;

constexpr std::size_t kWordsOfDouble = sizeof(double) / sizeof(std::uint32_t);

template <class T>
bool has_room(const Buffer<T>& buffer, std::size_t n_more) {
  return n_more <= buffer.capacity() - buffer.size();
}

template <class T>
void make_room(Buffer<T>& buffer, std::size_t n_more) {
  if (!has_room(buffer, n_more)) {
    buffer.reserve(std::max(buffer.size() + n_more, 2 * buffer.capacity()));
  }
}

/// Whether there is room for the values of n_more vertices.
bool has_room(const std::vector<VertexAttribute>& attributes, std::size_t n_more) {
  return std::ranges::all_of(attributes, [n_more](const VertexAttribute& attribute) {
    return has_room(attribute.values, n_more * attribute.info.bytes());
  });
}

/// What the mesh holds, or held when its memory was last used.
std::size_t bytes_of(const Mesh& mesh) {
  return mesh.positions.capacity() * sizeof mesh.positions[0] +
         mesh.positions_f64.capacity() * sizeof mesh.positions_f64[0] +
         mesh.normals.capacity() * sizeof mesh.normals[0] +
         mesh.triangles.capacity() * sizeof mesh.triangles[0];
}

}  // namespace

void MemorySink::start(Mesh& mesh) {
  mesh_ = &mesh;
  mesh.clear();
}

void MemorySink::set_slots(std::size_t n_slots) { places_.resize(n_slots); }

void MemorySink::begin_object(const MeshObject& object) {
  mesh_->attributes.resize(object.attributes.size());
  for (std::size_t n = 0; n < object.attributes.size(); ++n) {
    mesh_->attributes[n].info = object.attributes[n];
  }
  places_.resize(std::max<std::size_t>(places_.size(), 1));
}

void MemorySink::place(const MeshChunk& chunk, std::size_t slot) {
  Mesh& mesh = *mesh_;
  places_[slot] = {mesh.n_vertices(), mesh.triangles.size()};
  const std::size_t n_singles = chunk.positions.size() / 3;
  const std::size_t n_doubles = chunk.positions_f64.size() / 3;
  const std::size_t n_normals = chunk.normals.size() / 3;
  if (mesh.n_vertices() + chunk.n_vertices() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorKind::limit, {}, "the mesh has more than 2^32-1 vertices",
                "extract it in parts");
  }
  if (!has_room(mesh.positions, n_singles) || !has_room(mesh.positions_f64, n_doubles) ||
      !has_room(mesh.normals, n_normals) || !has_room(mesh.triangles, chunk.n_triangles()) ||
      !has_room(mesh.attributes, chunk.n_vertices())) {
    const std::lock_guard alone(moving_);
    make_room(mesh.positions, n_singles);
    make_room(mesh.positions_f64, n_doubles);
    make_room(mesh.normals, n_normals);
    make_room(mesh.triangles, chunk.n_triangles());
    for (VertexAttribute& attribute : mesh.attributes) {
      make_room(attribute.values, chunk.n_vertices() * attribute.info.bytes());
    }
  }
  mesh.positions.resize(mesh.positions.size() + n_singles);
  mesh.positions_f64.resize(mesh.positions_f64.size() + n_doubles);
  mesh.normals.resize(mesh.normals.size() + n_normals);
  mesh.triangles.resize(mesh.triangles.size() + chunk.n_triangles());
  for (VertexAttribute& attribute : mesh.attributes) {
    attribute.values.resize(mesh.n_vertices() * attribute.info.bytes());
  }
}

void MemorySink::write(const MeshChunk& chunk, std::size_t slot) {
  const std::shared_lock staying(moving_);
  Mesh& mesh = *mesh_;
  const auto [vertex, triangle] = places_[slot];
  const Stores stores = bytes_of(mesh) > kStreamedBytes ? Stores::streamed : Stores::cached;
  if (!chunk.positions.empty()) {
    move_words(chunk.positions.data(), chunk.positions.size(), 0, mesh.positions.data() + vertex,
               stores);
  }
  if (!chunk.positions_f64.empty()) {
    move_words(chunk.positions_f64.data(), kWordsOfDouble * chunk.positions_f64.size(), 0,
               mesh.positions_f64.data() + vertex, stores);
  }
  if (!chunk.normals.empty()) {
    move_words(chunk.normals.data(), chunk.normals.size(), 0, mesh.normals.data() + vertex, stores);
  }
  move_words(chunk.indices.data(), chunk.indices.size(),
             static_cast<std::uint32_t>(chunk.index_base), mesh.triangles.data() + triangle,
             stores);
  for (std::size_t n = 0; n < mesh.attributes.size(); ++n) {
    VertexAttribute& to = mesh.attributes[n];
    std::ranges::copy(chunk.attributes[n].values,
                      to.values.begin() + static_cast<std::ptrdiff_t>(vertex * to.info.bytes()));
  }
}

void MemorySink::end_object(const MeshTotals& /*totals*/) {}
void MemorySink::finish() { mesh_ = nullptr; }

}  // namespace mc::mesh
