// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "mc/base.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"
#include "mc/mesh.hpp"

// The port of extraction methods: what the pipe needs of one to mesh dense volumes slab by slab and
// sparse volumes block by block, on all threads and within a memory budget. A program adds a method
// by a Method of its own and names it in ExtractOptions::method; there is no list of methods.

namespace mc {

/// Area and volume of the surface in one layer of cells, or in one block. Summed in the order of
/// layers, so that totals do not depend on how layers are divided between threads.
struct LayerSum {
  double area = 0;    ///< square world units
  double volume = 0;  ///< cubic world units: of the cones from one fixed point to the triangles
};

/// Figures of one part of a surface.
struct SurfaceTotals {
  std::uint64_t n_vertices = 0;  ///< that the part owns
  std::uint64_t n_triangles = 0;
  std::uint64_t n_boundary_edges = 0;  ///< on the border of the volume, not between parts
  Bounds bounds;                       ///< of the positions as stored, relative to the origin
  std::vector<LayerSum> layers;        ///< in order; only if ExtractOptions::measure

  /// Sets everything to zero; keeps the memory.
  void clear() {
    layers.clear();
    *this = {0, 0, 0, {}, std::move(layers)};
  }
};

/// Makes the mesh of layers that are too large for one chunk, in bands that are small enough.
class SlabBands {
 public:
  virtual ~SlabBands() = default;
  /// Starts with layers [l0, l1) of a slab, which must stay as it is until their last band is made.
  /// The vertices that come first in layer l0 are made only if `with_lowest`. Chunks hold at most
  /// `max_bytes`, which are at least SlabEngine::least_chunk_bytes().
  virtual void start(const Slab& slab, std::int32_t l0, std::int32_t l1, bool with_lowest,
                     std::uint64_t max_bytes) = 0;
  /// Prepares the next bands, in the order of the mesh. Returns their number; 0 after the last.
  virtual std::size_t next() = 0;
  /// Makes band `n` of those that next() prepared. Sets MeshChunk::index_base relative to the first
  /// vertex since start(), modulo 2^64.
  /// Threads  several bands at once, each with another `maker`.
  virtual void make(std::size_t n, std::size_t maker, MeshChunk& chunk, SurfaceTotals& totals) = 0;
};

/// Makes the surface in slabs of one dense volume with one set of options.
///
/// Layers are numbered along k from 0. Each owns some of the mesh's vertices and triangles; the
/// mesh is that of layer 0, then of layer 1 and so on, whatever the slabs. Triangles may use
/// vertices of the next layer, if these come first in it: slabs then need no exchange, since the
/// first vertices of the next slab follow the slab's own without a gap.
///
/// Threads  an engine serves one thread at a time and keeps its scratch from call to call; a run
/// has
///          several engines of the same arguments, which work at the same time.
class SlabEngine {
 public:
  virtual ~SlabEngine() = default;

  [[nodiscard]] virtual std::int32_t n_layers() const = 0;
  /// Most layers that one slab may have, such that its vertices fit 32-bit indices; at least 1.
  [[nodiscard]] virtual std::int32_t max_layers() const = 0;
  /// The volume's planes [first, second) that the mesh of layers [l0, l1) depends on.
  [[nodiscard]] virtual std::pair<std::int32_t, std::int32_t> planes_for(std::int32_t l0,
                                                                         std::int32_t l1) const = 0;

  /// Makes the surface of layers from l0 up to l1, or up to the layer with which the buffers of
  /// `chunk` would take more than `max_bytes`; of that layer only the vertices that come first are
  /// in the chunk. `slab` has at least the planes of planes_for(l0, l1). Indices count from the
  /// slab's first vertex. Clears `chunk` and `totals` first.
  /// Returns  the layer after the last; if that is l0, the chunk is empty.
  virtual std::int32_t extract(const Slab& slab, std::int32_t l0, std::int32_t l1,
                               std::uint64_t max_bytes, MeshChunk& chunk,
                               SurfaceTotals& totals) = 0;
  /// Counts vertices, triangles and boundary edges that extract() makes, without bounds and layers.
  virtual void count(const Slab& slab, std::int32_t l0, std::int32_t l1, SurfaceTotals& totals) = 0;

  /// Bytes of scratch that one engine keeps.
  [[nodiscard]] virtual std::uint64_t scratch_bytes() const = 0;
  /// Bytes of the mesh of `n_layers` layers at most, whatever the samples are.
  [[nodiscard]] virtual std::uint64_t max_mesh_bytes(std::int32_t n_layers) const = 0;
  /// Bytes that a chunk must be allowed: of the smallest band; without bands, those with which
  /// extract() can make one layer, whatever the samples are.
  [[nodiscard]] virtual std::uint64_t least_chunk_bytes() const = 0;

  /// Whether bands() and count_vertices() work. If not, slabs have one layer, which chunks must be
  /// able to hold.
  [[nodiscard]] virtual bool has_bands() const { return false; }
  /// Creates what makes bands on `n_makers` threads.
  [[nodiscard]] virtual std::unique_ptr<SlabBands> bands(std::size_t n_makers) const;
  /// Bytes of scratch of bands(n_makers).
  [[nodiscard]] virtual std::uint64_t bands_bytes(std::size_t n_makers) const;
  /// Counts the vertices of layers [l0, l1), those that come first in l0 only if `with_lowest`.
  virtual std::uint64_t count_vertices(const Slab& slab, std::int32_t l0, std::int32_t l1,
                                       bool with_lowest);

  /// Lets the other engines of a run leave this one, which outlives their use, what several of them
  /// need. Called before the run.
  virtual void share(std::span<SlabEngine* const> others);
  /// The samples may differ from now on; forgets what was kept of them.
  virtual void forget();

  /// Of an engine from Method::box: goes to another box of cells. Allocates nothing if the box
  /// before had the same size.
  virtual void set_box(const IndexBox& cells);
  /// The samples that the engine's cells depend on. Only of an engine from Method::box.
  [[nodiscard]] virtual IndexBox samples() const;
};

/// Makes runs of blocks of one sparse extraction. Keeps scratch: one for each thread.
class BlockWorker {
 public:
  virtual ~BlockWorker() = default;
  /// Makes blocks from `first` up to `last`, or up to the block with which the buffers of `chunk`
  /// would take more than `max_bytes`. Indices count from the run's first vertex, those past the
  /// run's own vertices name vertices of later blocks. Clears `chunk` and `totals` first.
  /// Returns  the block after the last.
  /// Errors   limit: a triangle spans more than 2^32 vertex ids.
  virtual std::size_t extract(std::size_t first, std::size_t last, std::uint64_t max_bytes,
                              MeshChunk& chunk, SurfaceTotals& totals) = 0;
  /// Counts vertices, triangles and boundary edges of blocks [first, last).
  virtual void count(std::size_t first, std::size_t last, SurfaceTotals& totals) = 0;
};

/// One extraction of a sparse volume: its constructor looks at the volume and lists the blocks that
/// hold the surface, ordered by (z, y, x), and how many vertices each has. With
/// ExtractOptions::part it lists the blocks of these layers.
/// Threads  const functions may be called from several threads at once.
class BlockEngine {
 public:
  virtual ~BlockEngine() = default;
  [[nodiscard]] virtual std::size_t n_blocks() const = 0;
  /// The layer of block n: its index along k.
  [[nodiscard]] virtual std::int32_t layer(std::size_t n) const = 0;
  /// The id of the first vertex of block n, or for n = n_blocks() the number of all.
  [[nodiscard]] virtual std::uint64_t first_vertex(std::size_t n) const = 0;
  /// Creates what makes blocks on one thread. Keeps a reference to the engine.
  [[nodiscard]] virtual std::unique_ptr<BlockWorker> worker() const = 0;

  /// Bytes that the engine itself keeps, and those of one worker.
  [[nodiscard]] virtual std::uint64_t plan_bytes() const = 0;
  [[nodiscard]] virtual std::uint64_t worker_bytes() const = 0;
  /// Bytes of the mesh of `n_blocks` blocks at most, whatever the samples are.
  [[nodiscard]] virtual std::uint64_t max_mesh_bytes(std::size_t n_blocks) const = 0;
  /// Triangles of a run of blocks at most, for each vertex.
  [[nodiscard]] virtual std::uint64_t max_triangles_per_vertex() const = 0;
};

/// An extraction method: its name, and how its engines are made. Must outlive the options that
/// point to it.
struct Method {
  std::string_view name;
  /// Errors   limit: one layer could hold more vertices than 32-bit ids can name.
  std::unique_ptr<SlabEngine> (*dense)(const Volume& volume, const Affine& to_world,
                                       const ExtractOptions& options);
  /// Null if the method meshes dense volumes only. Keeps a reference to the reader.
  std::unique_ptr<BlockEngine> (*sparse)(const LeafReader& reader, const Affine& to_world,
                                         const ExtractOptions& options) = nullptr;
  /// Creates an engine for the cells between the samples of a box, as they are in the surface of
  /// all cells, with its vertices and normals: layers count from the box's lowest sample. Null if
  /// the method cannot do this: it then serves no ChunkMesher.
  std::unique_ptr<SlabEngine> (*box)(const Volume& volume, const Affine& to_world,
                                     const ExtractOptions& options,
                                     const IndexBox& cells) = nullptr;
  /// Whether RunOptions::keep works with its engines. Only methods of this library can set it: the
  /// selection of components is not public.
  bool selects_components = false;
};

/// Marching cubes, dense and sparse: the method unless ExtractOptions names another.
[[nodiscard]] const Method& cubes_method();

}  // namespace mc
