// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "mc/mesh.hpp"
#include "mc/pipe.hpp"
#include "pipe/cube_grid.hpp"
#include "pipe/cube_store.hpp"
#include "pipe/triangle_feed.hpp"

// What a run with cube stages must know before it starts: the triangles of each cube, from which
// follow the memory that it takes and the size of the whole mesh.

namespace mc::pipe {

/// Bytes that a run holds beside the tasks of its extraction.
struct CubeBytes {
  std::uint64_t stores = 0;  ///< the mesh between extraction and sink
  std::uint64_t worker = 0;  ///< one cube in work
};

struct CubePlan {
  CubeCounts cubes;                ///< of the first pass
  std::uint64_t n_triangles = 0;   ///< of the whole mesh
  std::uint64_t max_vertices = 0;  ///< that lie in two layers of cubes, and of a chunk
  CubeBytes bytes;
};

/// Bytes of each vertex and triangle between extraction and sink.
Formatted stored_bytes(const RunOptions& options);

/// Bytes of `n_vertices` and `n_triangles` of a cube in work.
std::uint64_t worker_bytes(std::uint64_t n_vertices, std::uint64_t n_triangles,
                           const RunOptions& options);

/// The grid of a run. Errors   input: a map that cannot be inverted.
CubeGrid cube_grid(const Volume& volume, bool is_dense, const RunOptions& options);

/// The cubes of a triangle in the two passes.
struct PassCubes {
  Index3 first, second;
};

/// The cubes of triangles in the order of the mesh. Layers of cubes follow one another: where
/// stages have moved a triangle below the layer of the one before, it goes to that layer.
class CubeSequence {
 public:
  explicit CubeSequence(const CubeGrid& grid) : grid_(grid) {}
  /// The cubes of the next triangles; valid until the next call. Threads: works on several.
  std::span<const PassCubes> next(std::span<const CubeStore::Triangle> triangles,
                                  const CubeStore& store);
  /// The layer of the latest triangle.
  [[nodiscard]] std::optional<std::int32_t> z() const { return z_; }

 private:
  const CubeGrid& grid_;
  std::vector<PassCubes> cubes_;
  std::optional<std::int32_t> z_;
};

/// Counts the triangles of each cube of a mesh.
class CubeCounter final : public MeshSink {
 public:
  /// Keeps a reference to the grid. Chunks in the first `n_forward_slots` slots name no vertex
  /// before their own first one.
  CubeCounter(const CubeGrid& grid, std::size_t n_forward_slots)
      : cubes_(grid), n_forward_slots_(n_forward_slots) {}

  void begin_object(const MeshObject& /*object*/) override {}
  void place(const MeshChunk& chunk, std::size_t slot) override;
  void end_object(const MeshTotals& totals) override { n_triangles_ = totals.n_triangles; }
  void finish() override {}

  /// What a run of these options needs. To be called once, after end_object().
  [[nodiscard]] CubePlan plan(const RunOptions& options);

 private:
  /// Of the triangles in one layer of cubes of the first pass.
  struct LayerCounts {
    std::uint64_t n_triangles = 0, n_upper = 0;  ///< all, and those in the next layer when shifted
    std::uint64_t first_id = ~std::uint64_t{0}, last_id = 0;

    [[nodiscard]] std::uint64_t n_vertices() const { return last_id - first_id + 1; }
  };

  void count(const CubeStore::Triangle& triangle, const PassCubes& cubes);
  [[nodiscard]] std::uint64_t largest() const;

  CubeSequence cubes_;
  std::size_t n_forward_slots_;
  CubeStore store_;  ///< vertices only
  std::uint64_t n_dropped_ = 0;
  TriangleFeed feed_;
  std::map<std::int32_t, LayerCounts> layers_;
  CubeCounts first_, second_;
  Index3 latest_first_{}, latest_second_{};
  std::uint64_t* n_first_ = nullptr;  ///< counter of the latest cube
  std::uint64_t* n_second_ = nullptr;
  std::uint64_t max_chunk_vertices_ = 0;
  std::uint64_t n_triangles_ = 0;
};

}  // namespace mc::pipe
