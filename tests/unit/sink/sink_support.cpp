// SPDX-License-Identifier: MIT
#include "unit/sink/sink_support.hpp"

#include <sys/stat.h>

#include <array>
#include <thread>
#include <type_traits>

#include "field/visit_type.hpp"

namespace mc::test {

namespace {

constexpr std::array<std::array<double, 3>, 4> kCorners{
    {{0, 0, 0}, {1.5, 0, 0}, {0, 1, 0}, {0.1, 0, -2}}};
constexpr std::array<std::array<float, 3>, 4> kNormals{
    {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};
constexpr std::array<std::uint16_t, 4> kMaterials{0, 7, 8, 65535};
constexpr std::array<std::array<std::uint32_t, 3>, 4> kTriangles{
    {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};

/// The values of vertices [v0, v1).
VertexAttribute values_of(const AttributeInfo& info, std::size_t v0, std::size_t v1) {
  VertexAttribute made{info, Buffer<std::byte>((v1 - v0) * info.bytes())};
  field::visit_type(info.type, [&]<class T>(field::TypeTag<T>) {
    T* to = made.values_as<T>().data();
    for (std::size_t v = v0; v < v1; ++v) {
      for (std::size_t n = 0; n < info.n_components; ++n) {
        if constexpr (std::is_same_v<T, Half>) {
          *to++ = to_half(static_cast<float>(v) + 0.5F * static_cast<float>(n));
        } else if constexpr (std::is_floating_point_v<T>) {
          *to++ = static_cast<T>(v) + T{0.5} * static_cast<T>(n);
        } else {
          *to++ = static_cast<T>(info == material_attribute() ? kMaterials[v] : v + n);
        }
      }
    }
  });
  return made;
}

MeshChunk part(const Tetrahedron& mesh, std::size_t v0, std::size_t v1, std::size_t t0,
               std::size_t t1, std::uint32_t base) {
  MeshChunk chunk;
  chunk.index_base = base;
  for (std::size_t v = v0; v < v1; ++v) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (mesh.precision == Precision::f64) {
        chunk.positions_f64.push_back(kCorners[v][a]);
      } else {
        chunk.positions.push_back(static_cast<float>(kCorners[v][a]));
      }
      if (mesh.has_normals) {
        chunk.normals.push_back(kNormals[v][a]);
      }
    }
  }
  for (const AttributeInfo& info : mesh.all_attributes()) {
    chunk.attributes.push_back(values_of(info, v0, v1));
  }
  for (std::size_t t = t0; t < t1; ++t) {
    for (const std::uint32_t id : kTriangles[t]) {
      chunk.indices.push_back(id - base);
    }
  }
  return chunk;
}

}  // namespace

std::vector<AttributeInfo> Tetrahedron::all_attributes() const {
  std::vector<AttributeInfo> all = attributes;
  if (has_materials) all.insert(all.begin(), material_attribute());
  return all;
}

MeshObject Tetrahedron::object(bool counts, const std::string& name) const {
  MeshObject made;
  made.name = name;
  made.iso = 0.5;
  made.has_normals = has_normals;
  made.attributes = all_attributes();
  made.precision = precision;
  if (counts) {
    made.n_vertices = 4;
    made.n_triangles = 4;
  }
  return made;
}

std::vector<MeshChunk> Tetrahedron::chunks(int cut) const {
  std::vector<MeshChunk> made;
  if (cut == 0) {
    made.push_back(part(*this, 0, 4, 0, 4, 0));
  } else if (cut == 1) {
    made.push_back(part(*this, 0, 3, 0, 3, 0));
    made.push_back(part(*this, 3, 4, 3, 4, 1));
  } else {
    for (std::size_t i = 0; i < 4; ++i) {
      made.push_back(part(*this, 0, 0, i, i + 1, 0));
      made.push_back(part(*this, i, i + 1, 0, 0, 0));
    }
  }
  return made;
}

MeshTotals Tetrahedron::totals() {
  MeshTotals made;
  made.n_vertices = 4;
  made.n_triangles = 4;
  return made;
}

std::vector<Way> all_ways() {
  std::vector<Way> ways;
  for (const bool stream : {false, true}) {
    for (const bool counts : {false, true}) {
      for (const int cut : {0, 1, 2}) {
        ways.push_back({stream, counts, cut});
      }
    }
  }
  return ways;
}

std::string through_fifo(const std::function<void(const std::string&)>& body) {
  const TemporaryFolder folder;
  const std::string fifo = folder / "fifo";
  if (::mkfifo(fifo.c_str(), 0600) != 0) {
    return "no FIFO";
  }
  std::string came;
  std::thread reader([&] { came = read_all(fifo); });
  body(fifo);
  reader.join();
  return came;
}

std::string written(const Tetrahedron& mesh, SinkOptions options, const Way& way,
                    std::size_t n_objects) {
  const auto write_to = [&](const std::string& path) {
    const auto sink = open_mesh_sink(path, options);
    for (std::size_t i = 0; i < n_objects; ++i) {
      sink->begin_object(mesh.object(way.counts, "part " + std::to_string(i + 1)));
      for (const MeshChunk& chunk : mesh.chunks(way.cut)) {
        sink->put(chunk);
      }
      sink->end_object(Tetrahedron::totals());
    }
    sink->finish();
  };
  if (way.stream) {
    return through_fifo(write_to);
  }
  const TemporaryFolder folder;
  write_to(folder / "out");
  return folder.n_entries() == 1 ? read_all(folder / "out") : "left something behind";
}

}  // namespace mc::test
