// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>

#include "mc/components.hpp"
#include "mc/edit.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"
#include "mc/mesh.hpp"
#include "mc/process.hpp"

// Drives a volume through the engine: into a sink, slab by slab, or in chunks, of which only those
// that an edit reaches are made again.

namespace mc {

/// Whether exact counts come before the mesh, at the price of one more read of the scalars.
enum class CountFirst : std::uint8_t {
  no,
  yes,
  if_large,  ///< where a sixteenth of the slabs says that a sink would rather not spool the faces
};

/// What a run will hold, in bytes, the program itself included and pages of mapped files aside.
struct MemoryNeed {
  std::uint64_t budget = 0;    ///< RunOptions::memory_bytes
  std::uint64_t least = 0;     ///< the smallest budget that works
  std::uint64_t expected = 0;  ///< at most, for the surface that is there, or a smooth one
  std::uint64_t most = 0;      ///< at most, whatever the samples are
};

struct RunOptions {
  ExtractOptions extract;
  std::optional<Affine> to_world;  ///< instead of the volume's own
  MeshObject object;  ///< only its name is read: the run fills in the rest from these options
  /// The process stays within it, pages of mapped files aside, and what the tree of a sparse volume
  /// is more than half of it.
  std::uint64_t memory_bytes = 1ULL << 30;
  std::int32_t slab_layers = 0;             ///< cell layers a task; 0: chosen from the plane's size
  std::uint64_t chunk_bytes = 0;            ///< a chunk at most; 0: chosen from memory_bytes
  std::optional<KeepRule> keep;             ///< components that remain; unset: all. Not for streams
  CountFirst count_first = CountFirst::no;  ///< ignored for streams, which are read once
  AttributeReaders attributes;              ///< what vertices carry; pass check_attributes()
  MeshStages stages{};       ///< applied to the mesh on its way to the sink, in order
  CubeStages cube_stages{};  ///< applied after `stages`, in order; not for parts
  bool skip = true;          ///< let the reader leave out samples far from the surface; same mesh
  /// MeshNeeds::formatted of the sink, and SinkFormat::attribute_bytes of each attribute.
  Formatted formatted;
  std::function<void(const MemoryNeed&)> tell_need;  ///< called before the work; or empty
};

/// All layers that ExtractOptions::part can choose from (a part that the options name is ignored):
/// dense, layers of cells from 0, those that lead to a closed border's constant layer included;
/// sparse, layers of 8x8x8 blocks by their index along k, which may be negative.
/// Errors   limit: as run(). Cost: dense, none; sparse, a look at all tiles.
LayerRange part_layers(const VolumeReader& reader, const RunOptions& options);

/// What a run needs; of a dense volume the surface is taken to be smooth, as large as one across
/// it. With stages that reach beyond a chunk, counts the surface of all but streams by a pass over
/// all samples. Errors   limit: options.memory_bytes are less than the least.
MemoryNeed memory_needed(const VolumeReader& reader, const RunOptions& options);

/// What a run needs, with the surface counted by a pass over all samples. `streamed`: the run will
/// read these samples from a stream. Precondition: `reader` is no stream.
/// Errors   as memory_needed(); those of the reader.
MemoryNeed memory_counted(const VolumeReader& reader, const RunOptions& options,
                          const std::stop_token& stop, bool streamed = false);

/// Refuses, before anything is read, a dense run that cannot keep its budget. What a sparse run
/// needs shows when it is planned, in run(), and what windows of stages need when the surface has
/// been counted. Errors   limit.
void check_memory(const VolumeReader& reader, const RunOptions& options);

/// Extracts one iso of `reader` into `sink`: begin_object, chunks in order, end_object.
/// The sink is not touched until the first triangle exists; `allow_empty` hands it an empty object.
/// Stages   figures are those of the mesh that they leave. If no stage reaches beyond a chunk and
///          one moves vertices, area and volume stay unset: the vertices of a triangle may lie in
///          several chunks. If a stage changes counts, the sink learns them at the end, or with
///          CountFirst::yes from a pass that makes the mesh and applies the stages. So with cube
///          stages, which count as such.
/// Errors   empty: no surface (unless allow_empty); limit: memory; those of reader and sink; usage:
///          a stream with stages that reach beyond a chunk, or with cube stages; a part with cube
///          stages.
/// Threads  uses the caller's arena; what the sink receives does not depend on the thread count or
///          slab thickness but for where chunks are cut.
/// Part     of options.extract.part: counts are of the vertices that the part owns; area and volume
///          are its share, which is a volume only when all parts are added and none has a boundary.
/// Cancel   looked at once a slab; throws Cancelled.
MeshTotals run(const VolumeReader& reader, const RunOptions& options, bool allow_empty,
               MeshSink& sink, Progress& progress, const std::stop_token& stop);

struct ChunkOptions {
  ExtractOptions extract;
  std::optional<Affine> to_world;  ///< instead of the volume's own
  std::int32_t n_cells = 16;       ///< along a chunk's edge: a power of two from 8 to 256
};

/// The surface in a cube of cells: what remains of the whole volume's without the other cells.
/// Vertices on a face that two chunks share are in both, bit for bit with their normals. A chunk
/// has the attribute material only if it is not 0 at one of its vertices.
struct SurfaceChunk {
  Index3 id{};     ///< c: the cells that start at samples c n_cells to c n_cells + n_cells - 1
  MeshChunk mesh;  ///< indices count from its own first vertex; empty where no surface is left
  MeshTotals totals;
};

/// Sums over the chunks that have a surface.
struct ChunkSums {
  std::uint64_t n_chunks = 0;
  std::uint64_t n_vertices = 0;  ///< those on shared faces counted in each
  std::uint64_t n_triangles = 0;
};

/// The surface of a volume under edits, in chunks. A chunk that an edit reaches is made again and
/// handed out; who wants to keep meshes keeps them. A chunk's bytes depend on the samples
/// and what is painted on them: they are those that a new mesher makes of the same volume, on any
/// number of threads.
/// Border   as the options say, at the border of the volume or region, and nowhere else: cells that
///          lead to the constant layer around it belong to the chunks at the border.
/// Threads  one caller; uses its arena where there are several chunks.
/// Memory   a chunk's samples and mesh for each thread, and 40 bytes a chunk with a surface.
class ChunkMesher {
 public:
  /// Takes each chunk that was made again, ordered by (z, y, x) of the id; one call at a time, on
  /// any thread. The chunk's memory is used again afterwards.
  using Take = std::function<void(const SurfaceChunk&)>;

  /// Keeps a reference to `store`, which must outlive the mesher.
  /// Errors   usage: n_cells, an iso that is not finite.
  ChunkMesher(const EditStore& store, const ChunkOptions& options);
  ~ChunkMesher();
  ChunkMesher(ChunkMesher&& other) noexcept;
  ChunkMesher& operator=(ChunkMesher&& other) noexcept;

  /// Makes every chunk that has a surface, and hands out what had one before with an empty mesh.
  /// Cost     dense: all samples; sparse: leaves and the faces of tiles.
  void build(const Take& take);
  /// Makes the chunks again whose cells or normals samples in the boxes can reach. Hands out those
  /// with a surface, and with an empty mesh those that had one and have none now.
  /// Errors   those of the store's input and of `take`: build() again after one.
  /// Cost     samples in these chunks, then their surface. Allocates nothing once it has made
  ///          chunks of the size, but where a chunk gets its first surface.
  void update(std::span<const IndexBox> dirty, const Take& take);

  /// Chunks that update() would look at for this box.
  [[nodiscard]] std::uint64_t n_reached(const IndexBox& samples) const;
  /// Whether a chunk has a surface, as far as it was made.
  [[nodiscard]] bool has_surface(const Index3& id) const;
  [[nodiscard]] const ChunkSums& sums() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mc
