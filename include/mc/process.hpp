// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "mc/base.hpp"
#include "mc/mesh.hpp"

// Stages: what happens to a mesh between the extraction and the sink. A program adds a stage by a
// MeshStage of its own and names it in RunOptions::stages or ConvertOptions::stages.
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

}  // namespace mc
