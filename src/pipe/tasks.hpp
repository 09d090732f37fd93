// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "mc/mesh.hpp"
#include "mc/method.hpp"
#include "mc/pipe.hpp"
#include "pipe/plane_input.hpp"
#include "process/figures.hpp"

// A run as the pipe sees it, dense or sparse: a list of tasks, each of which makes one chunk. Where
// a task's mesh is more than its chunk may hold, the rest of it comes in pieces, which are made
// when all before them has left the pipe: so memory is bounded whatever the samples are.

namespace mc::pipe {

/// Adds numbers one by one to a list that is as long, or empty.
inline void add_each(std::vector<std::uint64_t>& sums, const std::vector<std::uint64_t>& more) {
  sums.resize(std::max(sums.size(), more.size()));
  for (std::size_t n = 0; n < more.size(); ++n) sums[n] += more[n];
}

/// What one task found: of the surface, and on the way to it.
struct TaskTotals : SurfaceTotals {
  std::uint64_t n_asked = 0, n_skipped = 0;  ///< as in MeshTotals
  std::vector<std::uint64_t> n_clamped;      ///< as in MeshTotals
  std::optional<process::SurfaceSums> sums;  ///< if measured after stages, instead of layers

  /// Adds what a piece of the task found; vertices have been counted.
  void add_piece(const TaskTotals& piece) {
    n_triangles += piece.n_triangles;
    n_boundary_edges += piece.n_boundary_edges;
    add_each(n_clamped, piece.n_clamped);
    bounds.include(piece.bounds);
    layers.insert(layers.end(), piece.layers.begin(), piece.layers.end());
  }
};

/// What a task or a piece leaves behind, in a slot that is used again.
struct TaskResult {
  MeshChunk chunk;    ///< index_base counts from this task's first vertex until the pipe moves it
  TaskTotals totals;  ///< of the chunk; but vertices are counted of the whole task
  bool complete = true;  ///< else pieces follow
};

/// How many things are on their way at once, and how large their chunks may grow.
struct Room {
  std::size_t n_slots = 1;
  std::uint64_t chunk_bytes = 0;
  std::size_t n_makers = 1;  ///< of pieces
  std::uint64_t piece_bytes = 0;
};

/// Of a mesh or a part of it.
struct Counts {
  std::uint64_t n_vertices = 0, n_triangles = 0, n_boundary_edges = 0;
};

/// Bytes that a run holds beside its tasks and their chunks: as it is planned, and at least.
struct KeptBytes {
  std::uint64_t planned = 0, least = 0;
};

/// The work of one extraction. make() may be called from several threads with different slots.
class TaskList {
 public:
  virtual ~TaskList() = default;
  KeptBytes kept;
  /// Looks at the volume as far as fit() must know it. Before all below, or not at all if only an
  /// estimate is wanted.
  virtual void plan(Progress& /*progress*/, const std::stop_token& /*stop*/) {}
  /// Chooses the size of tasks so that what so many of them hold beside chunks keeps within `bytes`
  /// where it can. Before all below.
  virtual void fit(std::size_t /*n_slots*/, std::uint64_t /*bytes*/) {}
  /// Makes scratch; before make() or count().
  virtual void set_room(const Room& room) = 0;
  /// The samples may be others from now on: what was kept of them is void.
  virtual void forget() {}
  [[nodiscard]] virtual std::size_t n_tasks() const = 0;
  /// Samples of task n, for progress.
  [[nodiscard]] virtual std::uint64_t samples(std::size_t n) const = 0;
  /// Reads what make() will need, where that must happen in order; called so before each make().
  virtual void fetch(std::size_t /*n*/, std::size_t /*slot*/) {}
  virtual void make(std::size_t n, std::size_t slot, TaskResult& out) = 0;
  /// Whether tasks can be completed piece by piece. If not, chunks have all of their tasks' mesh.
  [[nodiscard]] virtual bool has_pieces() const { return true; }
  /// Goes on with a task that is not complete, of which nothing may be in the way: prepares pieces,
  /// one after the other in order, and returns how many; 0 when nothing is left. For one task at a
  /// time.
  virtual std::size_t next_pieces(std::size_t slot) = 0;
  /// Makes one of them; in its chunk, index_base counts from the vertices that the task's own chunk
  /// does not hold. May be called from several threads with different makers.
  virtual void make_piece(std::size_t piece, std::size_t maker, TaskResult& out) = 0;
  /// What all tasks will find, if that is known already.
  [[nodiscard]] virtual std::optional<Counts> known_counts() const { return std::nullopt; }
  /// About how many triangles all tasks will make, judged by a few layers; null: unknown. After
  /// set_room().
  [[nodiscard]] virtual std::optional<std::uint64_t> estimate_triangles() const {
    return std::nullopt;
  }
  /// Only counts.
  virtual void count(std::size_t n, std::size_t slot, TaskResult& out) = 0;
  /// Bytes that a run holds beside chunks.
  [[nodiscard]] virtual std::uint64_t held_bytes(std::size_t n_slots,
                                                 std::size_t n_makers) const = 0;
  /// Bytes that chunks of tasks and pieces must be allowed.
  [[nodiscard]] virtual std::uint64_t least_chunk_bytes() const = 0;
  /// Bytes that one task fills its chunk with, of a smooth surface.
  [[nodiscard]] virtual std::uint64_t smooth_content_bytes() const = 0;
  /// Bytes that one task can fill its chunk with, whatever the samples are.
  [[nodiscard]] virtual std::uint64_t most_content_bytes() const = 0;
  /// Bytes that the input holds.
  [[nodiscard]] virtual std::uint64_t input_bytes() const { return 0; }
};

/// Errors   usage: options.extract.part is not of layers that exist, or the method cannot mesh such
/// a
///          volume; limit: one layer could hold more vertices than 32-bit ids can name.
std::unique_ptr<TaskList> dense_tasks(const PlaneInput& input, const RunOptions& options);
std::unique_ptr<TaskList> sparse_tasks(const LeafReader& reader, const RunOptions& options);
/// Plans the blocks of a sparse volume. Errors   as sparse_tasks().
std::unique_ptr<BlockEngine> block_engine(const LeafReader& reader, const RunOptions& options);

/// The layers that there are, as mc::part_layers().
LayerRange dense_layers(const Volume& volume, const RunOptions& options);
LayerRange sparse_layers(const LeafReader& reader, const RunOptions& options);

/// The middle of the volume, from which cones are measured, relative to the origin.
Vec3 cone_apex(const Volume& volume, const RunOptions& options);

/// The method that the options name.
const Method& method_of(const ExtractOptions& options);
/// options.part, or all layers. Errors   usage: a part that is not within `all`.
LayerRange chosen_layers(const ExtractOptions& options, const LayerRange& all);

}  // namespace mc::pipe
