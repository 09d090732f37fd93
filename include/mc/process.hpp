// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "mc/base.hpp"
#include "mc/mesh.hpp"

// Stages: what happens to a mesh between the extraction and the sink. A program adds a stage by a
// MeshStage of its own and names it in RunOptions::stages or ConvertOptions::stages, or by a
// CubeStage and names it in the cube_stages of these options. The order is fixed: first all
// MeshStages, then all CubeStages, then the sampling of attributes.
//
// MeshStages
//
// A run never holds the whole mesh. It hands a stage one window of the mesh after the other, and
// puts the windows' own parts together. The mesh consists of layers of cells along k:
//   - each layer has its own vertices and triangles; the mesh is layer 0, then layer 1, and so on;
//   - the triangles of layer l name vertices of layers l and l + 1 only.
// A sparse volume is numbered by 8x8x8 blocks, one layer of blocks after the other, in which eight
// layers of cells are mixed.
//
// The law of stages: what a stage makes of a vertex or triangle of layer l depends on nothing but
// the vertices and triangles of layers l - reach() to l + reach(), their order, and the stage's own
// parameters. It depends neither on where a window begins and ends nor on which part of it is the
// window's own. Then the output has the same bytes for any number of threads, memory budget and
// slab thickness.
//
// CubeStages
//
// These work on the mesh of one cube of cells at a time, in which they may drop and add vertices
// and triangles. There are two passes. The first cuts the mesh into cubes of n_cells() cells along
// each edge; the second cuts the result into cubes that are shifted by half of that:
//
//     first pass              second pass
//     +-------+-------+       +---+-------+---+
//     |       |       |       |   |       |   |
//     |       |       |       +---+-------+---+
//     +-------+-------+       |   |       |   |
//     |       |       |       |   |       |   |
//     |       |       |       +---+-------+---+
//     +-------+-------+       +---+-------+---+
//
// A triangle belongs to the cube that its centroid lies in. Vertices with triangles in several
// cubes are the seam, which must stay as it is. What is on the seam of the first pass is almost
// everywhere inside a cube of the second one. Cubes start at the lowest sample of a dense volume or
// of the region, and at multiples of n_cells() in a sparse one.
//
// The law of cube stages: what a stage makes of a cube depends on nothing but that cube. The edges
// that have one triangle in the cube (at the seam, and where the mesh has a border) stay as they
// are, with their vertices. Then the cubes fit together, the mesh has the same boundary edges as
// before, and the output has the same bytes for any number of threads and memory budget.
//
// The mesh then consists of the cubes of the second pass, ordered by (z, y, x). A vertex belongs to
// the first cube that uses it, so triangles name vertices of their own and of earlier cubes.

namespace mc {

/// Elements [first, last) of a sequence.
struct IndexRange {
  std::size_t first = 0, last = 0;

  [[nodiscard]] std::size_t size() const { return last - first; }
  bool operator==(const IndexRange&) const = default;
};

/// A part of a mesh that a stage changes in place.
///
/// For a stage that reaches no other layer (reach() is 0), the window is any run of successive
/// vertices, all of them its own. There may be triangles as well, but they name vertices of any
/// window: no triangle is the window's own, and the stage must leave `mesh.indices` as they are.
///
/// For other stages, the window holds the layers that are its own between those of a halo below and
/// above. Indices count from the window's first vertex, and all name vertices of the window. The
/// halo is deep enough for the results of all stages to be right in the own layers and in what the
/// own triangles name of the layer above. Vertices at the outer end of the halo lack triangles;
/// what a stage makes of them is not used.
struct MeshWindow {
  MeshChunk& mesh;  ///< index_base means nothing here, and attributes are not there yet
  Vec3 origin{};    ///< MeshObject::origin: positions are relative to it
  IndexRange own_vertices{}, own_triangles{};

  [[nodiscard]] std::size_t n_vertices() const { return mesh.n_vertices(); }
  [[nodiscard]] std::size_t n_triangles() const { return mesh.n_triangles(); }
  /// Position of a vertex, relative to the origin, in single or double precision as stored.
  [[nodiscard]] Vec3 position(std::size_t vertex) const;
  /// Rounds to the stored precision.
  void set_position(std::size_t vertex, const Vec3& position);

  /// Drops vertices and triangles, and keeps the order of the others: a vertex stays if its entry
  /// in `vertices` is not 0, a triangle stays if its entry in `triangles` is not 0 and its vertices
  /// stay. Renumbers the indices and adjusts the own ranges. Only for a stage with
  /// changes_counts(), which must drop and keep the halo's vertices by the same rule as its own:
  /// indices that lead to the next window are then right without any exchange between windows.
  /// Cost     O(window) time; 4 bytes of scratch for each vertex, which the run counts itself.
  void keep(std::span<const std::uint8_t> vertices, std::span<const std::uint8_t> triangles);
};

/// Memory of a stage, in bytes.
struct StageBytes {
  std::uint64_t held = 0;           ///< as long as the stage exists
  std::uint32_t each_vertex = 0;    ///< allocated by apply(), for each vertex of the window
  std::uint32_t each_triangle = 0;  ///< for each triangle
};

/// One step of what is done to a mesh. All answers stay the same during a run. The stages of a run
/// are applied in order; none sees the attributes, which are sampled at the final positions.
class MeshStage {
 public:
  virtual ~MeshStage() = default;
  /// As messages name it, in lower case.
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Layers of cells on each side that a vertex or triangle depends on, see the law above; for
  /// example 1 if a vertex depends on the vertices that share a triangle with it. With 0, each
  /// vertex depends on itself alone.
  /// Cost     of all stages with more than 0: the samples are read twice, and once more in the
  ///          halo, which is the sum of all reaches; the memory budget must hold a window of one
  ///          layer and its halo. Streams cannot be read twice.
  [[nodiscard]] virtual std::int32_t reach() const { return 0; }
  /// Whether it may change positions. If not, figures that the extraction measures stay true.
  [[nodiscard]] virtual bool moves_vertices() const { return true; }
  /// Whether it may drop vertices or triangles. It then reaches at least one layer.
  [[nodiscard]] virtual bool changes_counts() const { return false; }
  [[nodiscard]] virtual StageBytes bytes() const { return {}; }
  /// Updates the announced MeshObject, for example its has_normals.
  virtual void describe(MeshObject& /*object*/) const {}
  /// Changes a window. Vertices and triangles keep their order, and none are added.
  /// Threads  several calls at once, with different windows.
  virtual void apply(MeshWindow& window) const = 0;
};

/// Stages in the order in which they are applied. Borrowed: they must outlive the run.
using MeshStages = std::span<const MeshStage* const>;

/// How far vertices lie from a mesh that replaced theirs, in world units.
struct VertexDistances {
  std::uint64_t n = 0;     ///< vertices
  double sum_squares = 0;  ///< of their distances
  double max = 0;
};

/// The mesh of a cube of cells, which a stage changes. Vertices of the seam come first.
struct MeshCube {
  MeshChunk& mesh;           ///< index_base means nothing here, and attributes are not there yet
  Vec3 origin{};             ///< MeshObject::origin: positions are relative to it
  std::size_t n_seam = 0;    ///< the stage leaves vertices [0, n_seam) as and where they are
  double cell = 1;           ///< cube root of a cell's volume, in world units
  double n_extracted = 0;    ///< triangles that the surface in this cube had before the first pass
  std::uint64_t n_mesh = 0;  ///< triangles of the whole mesh before the first pass
  bool is_last_pass = false;
  VertexDistances distances{};  ///< set by stages that measure what they change
};

/// One step of what is done to a mesh, cube by cube. All answers stay the same during a run. If a
/// run has several, each is applied to a cube in order, in both passes.
/// Cost     of all cube stages together: the mesh is extracted twice, first to count the triangles
///          of each cube. A run holds the extracted mesh of two layers of cubes, what is left of
///          two layers, and one cube for each thread. Streams cannot be read twice.
class CubeStage {
 public:
  virtual ~CubeStage() = default;
  /// As messages name it, in lower case.
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Cells along a cube's edge: even, at least 2; the same for all cube stages of a run. The output
  /// depends on it.
  [[nodiscard]] virtual std::int32_t n_cells() const { return 64; }
  [[nodiscard]] virtual StageBytes bytes() const { return {}; }
  /// Whether it sets MeshCube::distances.
  [[nodiscard]] virtual bool measures() const { return false; }
  /// Updates the announced MeshObject, for example its has_normals.
  virtual void describe(MeshObject& /*object*/) const {}
  /// Changes a cube. It must not have more vertices or triangles afterwards.
  /// Threads  several calls at once, with different cubes.
  virtual void apply(MeshCube& cube) const = 0;
};

/// Cube stages in the order in which they are applied. Borrowed: they must outlive the run.
using CubeStages = std::span<const CubeStage* const>;

}  // namespace mc
