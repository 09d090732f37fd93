// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mc/base.hpp"
#include "mc/components.hpp"
#include "mc/field.hpp"

// Triangle meshes, whole (Mesh) or as a stream of chunks (MeshChunk into a MeshSink), and their
// figures.

namespace mc {

enum class Precision : std::uint8_t { f32, f64 };

struct Bounds {
  Vec3 lo{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
          std::numeric_limits<double>::infinity()};
  Vec3 hi{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
          -std::numeric_limits<double>::infinity()};

  [[nodiscard]] bool empty() const { return !(lo[0] <= hi[0]); }
  void include(const Vec3& p);
  void include(const Bounds& other);
};

/// How far the vertices of a mesh lie from the mesh that replaced it, in world units. Each of the
/// two passes of cube stages is measured; these are the sums of both, so the true distances are at
/// most these.
struct MeshDistances {
  double rms = 0, max = 0;
};

/// What is known of a mesh without holding it. World units.
struct MeshTotals {
  std::uint64_t n_vertices = 0;
  std::uint64_t n_triangles = 0;
  std::uint64_t n_boundary_edges = 0;
  Bounds bounds;                 ///< of the vertices as stored
  std::optional<double> area;    ///< only when measured
  std::optional<double> volume;  ///< positive for outward winding; only when measured and closed
  /// Samples that dense slabs asked for, those between two slabs in both, and how many of them the
  /// source skipped because the surface was not near. Facts of the run, not of the mesh.
  std::uint64_t n_asked = 0, n_skipped = 0;
  std::optional<ComponentCounts> components;  ///< only if some were to be left out
  /// Of each attribute, in the order of MeshObject::attributes: vertices whose value was clamped,
  /// as AttributeReader::values_at() counts them.
  std::vector<std::uint64_t> n_clamped;
  std::uint64_t n_extracted = 0;           ///< triangles before cube stages; 0 without
  std::optional<MeshDistances> distances;  ///< only if a cube stage measures them

  /// V - E + F, with E = (3F + boundary) / 2: exact, since no edge has more than two triangles.
  [[nodiscard]] std::int64_t euler() const;
};

/// The values of one attribute at all vertices of a chunk or a mesh.
struct VertexAttribute {
  AttributeInfo info;
  Buffer<std::byte> values;  ///< info.bytes() a vertex, in native byte order

  /// The values as numbers of the C++ type of info.type.
  template <class T>
  [[nodiscard]] std::span<const T> values_as() const {
    return {reinterpret_cast<const T*>(values.data()), values.size() / sizeof(T)};
  }
  template <class T>
  [[nodiscard]] std::span<T> values_as() {
    return {reinterpret_cast<T*>(values.data()), values.size() / sizeof(T)};
  }
  bool operator==(const VertexAttribute&) const = default;
};

/// Part of a mesh, in order: its vertices follow those of the chunks before it. An index names
/// vertex index_base + index of the whole mesh, which may lie in another chunk.
struct MeshChunk {
  std::uint64_t index_base = 0;
  Buffer<float> positions;        ///< x, y, z each; empty when double precision was asked for
  Buffer<double> positions_f64;   ///< x, y, z each; only when double precision was asked for
  Buffer<float> normals;          ///< x, y, z each, unit length; empty without normals
  Buffer<std::uint32_t> indices;  ///< three a triangle, counter-clockwise seen from outside
  std::vector<VertexAttribute> attributes;  ///< those of MeshObject::attributes, in their order

  [[nodiscard]] std::size_t n_vertices() const {
    return (positions.size() + positions_f64.size()) / 3;
  }
  [[nodiscard]] std::size_t n_triangles() const { return indices.size() / 3; }
  void clear();  ///< keeps the memory
};

/// One object (one iso) of an output, announced before its chunks.
struct MeshObject {
  std::string name;  ///< "iso 0.5", or the grid's name
  double iso = 0;
  bool has_normals = false;
  std::vector<AttributeInfo> attributes;
  Precision precision = Precision::f32;
  /// Added to every position (the node's translation in glTF); zero unless the sink asked for it.
  Vec3 origin{};
  /// Exact counts, where a counting pass was made.
  std::optional<std::uint64_t> n_vertices;
  std::optional<std::uint64_t> n_triangles;
};

/// Bytes that a sink makes, at most, of each vertex and each triangle of a chunk, beside the chunk.
struct Formatted {
  std::uint32_t vertex_bytes = 0;
  std::uint32_t triangle_bytes = 0;
};

/// What a sink needs to know before it can say how positions must come.
struct MeshNeeds {
  Precision precision = Precision::f32;  ///< of positions
  bool relative_origin = false;          ///< positions come relative to MeshObject::origin
  Formatted formatted;
};

/// The port by which meshes leave. Calls: set_slots, (begin_object, chunks, end_object)..., finish.
/// Destroyed before finish(), it leaves nothing behind.
///
/// A chunk goes through three steps, in all of which it has the same slot, its own until the last
/// has ended: what a sink keeps of a chunk from step to step lives there. A chunk may be empty.
/// Chunks are in order, and only place() sees them so; the other two run on several threads, each
/// with another slot. Between begin_object() and end_object() of one object nothing else is called.
class MeshSink {
 public:
  virtual ~MeshSink() = default;
  /// So many chunks may be on their way at once (one, where this is not called).
  virtual void set_slots(std::size_t n_slots);
  /// Errors: limit, when counts that are known already do not fit the format; output.
  virtual void begin_object(const MeshObject& object) = 0;
  /// Any thread: makes what will be written of the chunk, as far as that needs no place.
  virtual void format(const MeshChunk& chunk, std::size_t slot);
  /// One at a time, in order: says where the chunk goes; writes it, where the output cannot seek.
  /// Errors: limit, output.
  virtual void place(const MeshChunk& chunk, std::size_t slot) = 0;
  /// Any thread: puts it there. Errors: output.
  virtual void write(const MeshChunk& chunk, std::size_t slot);
  virtual void end_object(const MeshTotals& totals) = 0;
  /// Completes the output and puts it under its name(s).
  virtual void finish() = 0;
  /// All steps of the next chunk, for who has one thread.
  void put(const MeshChunk& chunk);
};

/// A mesh in memory. Positions are in one of two buffers, and triangles are in one of two; the
/// other one is empty. A mesh that was read from a file may have triangles with ids past the last
/// vertex.
struct Mesh {
  Buffer<std::array<float, 3>> positions;
  Buffer<Vec3> positions_f64;            ///< instead, if positions are in double precision
  Buffer<std::array<float, 3>> normals;  ///< one a vertex, or none
  /// Vertex ids, counter-clockwise seen from outside.
  Buffer<std::array<std::uint32_t, 3>> triangles;
  Buffer<std::array<std::uint64_t, 3>>
      triangles_u64;  ///< instead, if an id needs more than 32 bits
  std::vector<VertexAttribute> attributes;

  [[nodiscard]] std::size_t n_vertices() const { return positions.size() + positions_f64.size(); }
  [[nodiscard]] std::size_t n_triangles() const { return triangles.size() + triangles_u64.size(); }
  [[nodiscard]] Vec3 position(std::size_t vertex) const {
    if (positions.empty()) return positions_f64[vertex];
    const auto& p = positions[vertex];
    return {double{p[0]}, double{p[1]}, double{p[2]}};
  }
  [[nodiscard]] std::array<std::uint64_t, 3> triangle(std::size_t number) const {
    if (triangles.empty()) return triangles_u64[number];
    const auto& ids = triangles[number];
    return {ids[0], ids[1], ids[2]};
  }
  /// Appends a triangle. The first id that needs more than 32 bits moves all triangles to
  /// triangles_u64.
  void add_triangle(const std::array<std::uint64_t, 3>& ids);
  void clear();  ///< keeps the memory
};

/// What `mc check` finds.
struct MeshReport {
  std::uint64_t n_vertices = 0, n_triangles = 0;
  std::uint64_t not_finite = 0;         ///< vertices with a coordinate or normal that is not finite
  std::uint64_t out_of_range = 0;       ///< triangles with an index past the last vertex
  std::uint64_t degenerate = 0;         ///< triangles of zero area or with a repeated vertex
  std::uint64_t duplicate = 0;          ///< triangles beyond the first on the same three vertices
  std::uint64_t boundary_edges = 0;     ///< one triangle
  std::uint64_t nonmanifold_edges = 0;  ///< more than two triangles
  std::uint64_t nonmanifold_vertices = 0;   ///< whose triangles form more than one fan
  std::uint64_t misoriented_edges = 0;      ///< two triangles that run the same way
  std::uint64_t unreferenced_vertices = 0;  ///< reported, no defect
  std::uint64_t duplicate_vertices = 0;  ///< same position as an earlier one; reported, no defect
  std::uint64_t components = 0;          ///< over shared vertices
  std::int64_t euler = 0;                ///< V - E + F over referenced vertices
  double area = 0, volume = 0;
  Bounds bounds;

  [[nodiscard]] bool closed() const { return boundary_edges == 0; }
  /// Status 7's reasons; boundary edges count only when `must_be_closed`.
  [[nodiscard]] bool defective(bool must_be_closed) const;
};

/// Checks a mesh.
/// Errors   none: whatever is wrong is counted.
/// Cost     O(n log n) time, about 40 bytes a triangle besides the mesh.
MeshReport check_mesh(const Mesh& mesh);

}  // namespace mc
