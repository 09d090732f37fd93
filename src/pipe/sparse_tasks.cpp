// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "extract/sparse/sparse_plan.hpp"
#include "mc/method.hpp"
#include "mesh/chunk_room.hpp"
#include "pipe/tasks.hpp"

// Sparse volumes: a task is a run of blocks; its pieces are shorter runs.

namespace mc::pipe {

namespace {

constexpr std::size_t kBlocksPerTask = 512;

class SparseTasks final : public TaskList {
 public:
  SparseTasks(const LeafReader& reader, const RunOptions& options)
      : reader_(reader), extract_(options.extract), engine_(block_engine(reader, options)) {}

  void set_room(const Room& room) override {
    room_ = room;
    slots_.clear();
    slots_.resize(room.n_slots);
    for (Slot& slot : slots_) slot.worker = engine_->worker();
    makers_.clear();
    makers_.resize(room.n_makers);
    for (std::unique_ptr<BlockWorker>& maker : makers_) maker = engine_->worker();
  }
  [[nodiscard]] std::size_t n_tasks() const override {
    return (engine_->n_blocks() + kBlocksPerTask - 1) / kBlocksPerTask;
  }
  [[nodiscard]] std::uint64_t samples(std::size_t n) const override {
    return (last(n) - n * kBlocksPerTask) * LeafReader::kLeafSamples;
  }
  void make(std::size_t n, std::size_t slot, TaskResult& out) override {
    Slot& s = slots_[slot];
    s.last = last(n);
    s.next =
        s.worker->extract(n * kBlocksPerTask, s.last, room_.chunk_bytes, out.chunk, out.totals);
    out.complete = s.next == s.last;
    out.totals.n_vertices += engine_->first_vertex(s.last) - engine_->first_vertex(s.next);
  }
  std::size_t next_pieces(std::size_t slot) override {
    first_ = slots_[slot].next;
    last_ = slots_[slot].last;
    slots_[slot].next = last_;
    return (last_ - first_ + blocks_per_piece() - 1) / blocks_per_piece();
  }
  void make_piece(std::size_t piece, std::size_t maker, TaskResult& out) override {
    const std::size_t first = first_ + piece * blocks_per_piece();
    makers_[maker]->extract(first, std::min(last_, first + blocks_per_piece()),
                            mesh::ChunkRoom::kUnlimited, out.chunk, out.totals);
    out.chunk.index_base = engine_->first_vertex(first) - engine_->first_vertex(first_);
  }
  void count(std::size_t n, std::size_t slot, TaskResult& out) override {
    slots_[slot].worker->count(n * kBlocksPerTask, last(n), out.totals);
  }
  [[nodiscard]] std::uint64_t held_bytes(std::size_t n_slots, std::size_t n_makers) const override {
    return engine_->plan_bytes() + (n_slots + n_makers) * engine_->worker_bytes();
  }
  [[nodiscard]] std::uint64_t least_chunk_bytes() const override { return piece_of(1); }
  [[nodiscard]] std::uint64_t smooth_content_bytes() const override { return content_with(2); }
  [[nodiscard]] std::uint64_t most_content_bytes() const override {
    return content_with(engine_->max_triangles_per_vertex());
  }
  [[nodiscard]] std::uint64_t input_bytes() const override { return reader_.held_bytes(); }

 private:
  struct Slot {
    std::unique_ptr<BlockWorker> worker;
    std::size_t next = 0, last = 0;  ///< blocks that its task's chunk could not hold
  };

  /// Of the largest chunk of a task, with so many triangles a vertex.
  [[nodiscard]] std::uint64_t content_with(std::uint64_t n_triangles) const {
    std::uint64_t n = 0;
    for (std::size_t task = 0; task < n_tasks(); ++task) {
      n = std::max(
          n, engine_->first_vertex(last(task)) - engine_->first_vertex(task * kBlocksPerTask));
    }
    return mesh::content_bytes(n, n_triangles * n, vertex_bytes()) + engine_->max_mesh_bytes(1);
  }
  [[nodiscard]] std::uint64_t vertex_bytes() const {
    return mesh::vertex_bytes(extract_.precision, extract_.normals != Normals::none);
  }
  [[nodiscard]] std::size_t last(std::size_t n) const {
    return std::min(engine_->n_blocks(), (n + 1) * kBlocksPerTask);
  }
  /// Bytes that a piece of so many blocks takes: a buffer that grows is there with its larger copy.
  [[nodiscard]] std::uint64_t piece_of(std::size_t n_blocks) const {
    return 3 * engine_->max_mesh_bytes(n_blocks);
  }
  [[nodiscard]] std::size_t blocks_per_piece() const {
    return std::clamp<std::size_t>(room_.piece_bytes / piece_of(1), 1, kBlocksPerTask);
  }

  const LeafReader& reader_;
  ExtractOptions extract_;
  std::unique_ptr<BlockEngine> engine_;
  Room room_;
  std::vector<Slot> slots_;
  std::vector<std::unique_ptr<BlockWorker>> makers_;
  std::size_t first_ = 0, last_ = 0;  ///< blocks of the pieces that are being made
};

}  // namespace

std::unique_ptr<TaskList> sparse_tasks(const LeafReader& reader, const RunOptions& options) {
  return std::make_unique<SparseTasks>(reader, options);
}

std::unique_ptr<BlockEngine> block_engine(const LeafReader& reader, const RunOptions& options) {
  const Method& method = method_of(options.extract);
  if (method.sparse == nullptr) {
    throw Error(
        ErrorKind::usage, reader.volume().name,
        "is sparse, and the method " + std::string(method.name) + " meshes dense volumes only");
  }
  chosen_layers(options.extract, sparse_layers(reader, options));
  return method.sparse(reader, options.to_world.value_or(reader.volume().lattice.to_world),
                       options.extract);
}

LayerRange sparse_layers(const LeafReader& reader, const RunOptions& options) {
  return extraction::block_layers(reader, options.extract);
}

}  // namespace mc::pipe
