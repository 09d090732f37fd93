// SPDX-License-Identifier: MIT
#include <algorithm>

#include "extract/sparse/sparse.hpp"
#include "mesh/chunk_room.hpp"
#include "pipe/tasks.hpp"

// Sparse volumes: a task is a run of blocks; its pieces are shorter runs.

namespace mc::pipe {

namespace {

constexpr std::size_t kBlocksPerTask = 512;

class SparseTasks final : public TaskList {
 public:
  SparseTasks(const LeafReader& reader, const RunOptions& options)
      : plan_(reader, options.extract),
        to_world_(options.to_world.value_or(reader.volume().lattice.to_world)) {}

  void set_room(const Room& room) override {
    room_ = room;
    slots_.clear();
    slots_.reserve(room.n_slots);
    for (std::size_t s = 0; s < room.n_slots; ++s) slots_.push_back({{plan_, to_world_}, 0, 0});
    makers_.clear();
    makers_.reserve(room.n_makers);
    for (std::size_t m = 0; m < room.n_makers; ++m) makers_.emplace_back(plan_, to_world_);
  }
  [[nodiscard]] std::size_t n_tasks() const override {
    return (plan_.blocks().size() + kBlocksPerTask - 1) / kBlocksPerTask;
  }
  [[nodiscard]] std::uint64_t samples(std::size_t n) const override {
    return (last(n) - n * kBlocksPerTask) * LeafReader::kLeafSamples;
  }
  void make(std::size_t n, std::size_t slot, TaskResult& out) override {
    Slot& s = slots_[slot];
    s.last = last(n);
    s.next =
        s.extractor.extract(n * kBlocksPerTask, s.last, room_.chunk_bytes, out.chunk, out.totals);
    out.complete = s.next == s.last;
    out.totals.n_vertices += plan_.first_vertex(s.last) - plan_.first_vertex(s.next);
  }
  std::size_t next_pieces(std::size_t slot) override {
    first_ = slots_[slot].next;
    last_ = slots_[slot].last;
    slots_[slot].next = last_;
    return (last_ - first_ + blocks_per_piece() - 1) / blocks_per_piece();
  }
  void make_piece(std::size_t piece, std::size_t maker, TaskResult& out) override {
    const std::size_t first = first_ + piece * blocks_per_piece();
    makers_[maker].extract(first, std::min(last_, first + blocks_per_piece()),
                           mesh::ChunkRoom::kUnlimited, out.chunk, out.totals);
    out.chunk.index_base = plan_.first_vertex(first) - plan_.first_vertex(first_);
  }
  void count(std::size_t n, std::size_t slot, TaskResult& out) override {
    slots_[slot].extractor.count(n * kBlocksPerTask, last(n), out.totals);
  }
  [[nodiscard]] std::uint64_t held_bytes(std::size_t n_slots, std::size_t n_makers) const override {
    return plan_.bytes() + (n_slots + n_makers) * extraction::SparseExtractor::scratch_bytes();
  }
  [[nodiscard]] std::uint64_t least_chunk_bytes() const override { return piece_of(1); }
  [[nodiscard]] std::uint64_t smooth_content_bytes() const override { return content_with(2); }
  [[nodiscard]] std::uint64_t most_content_bytes() const override {
    return content_with(4);  // a cell's edges, each of four cells, make two triangles fewer
  }
  [[nodiscard]] std::uint64_t input_bytes() const override { return plan_.reader().held_bytes(); }

 private:
  struct Slot {
    extraction::SparseExtractor extractor;
    std::size_t next, last;  // blocks that its task's chunk could not hold
  };

  /// Of the largest chunk of a task, with so many triangles a vertex.
  [[nodiscard]] std::uint64_t content_with(std::uint64_t n_triangles) const {
    std::uint64_t n = 0;
    for (std::size_t task = 0; task < n_tasks(); ++task) {
      n = std::max(n, plan_.first_vertex(last(task)) - plan_.first_vertex(task * kBlocksPerTask));
    }
    return mesh::content_bytes(n, n_triangles * n, vertex_bytes()) +
           extraction::SparseExtractor::most_bytes_of(1, plan_.options());
  }
  [[nodiscard]] std::uint64_t vertex_bytes() const {
    const ExtractOptions& o = plan_.options();
    return mesh::vertex_bytes(o.precision, o.normals != Normals::none);
  }
  [[nodiscard]] std::size_t last(std::size_t n) const {
    return std::min(plan_.blocks().size(), (n + 1) * kBlocksPerTask);
  }
  /// Bytes that a piece of so many blocks takes: a buffer that grows is there with its larger copy.
  [[nodiscard]] std::uint64_t piece_of(std::size_t n_blocks) const {
    return 3 * extraction::SparseExtractor::most_bytes_of(n_blocks, plan_.options());
  }
  [[nodiscard]] std::size_t blocks_per_piece() const {
    return std::clamp<std::size_t>(room_.piece_bytes / piece_of(1), 1, kBlocksPerTask);
  }

  extraction::SparsePlan plan_;
  Affine to_world_;
  Room room_;
  std::vector<Slot> slots_;
  std::vector<extraction::SparseExtractor> makers_;
  std::size_t first_ = 0, last_ = 0;  ///< blocks of the pieces that are being made
};

}  // namespace

std::unique_ptr<TaskList> sparse_tasks(const LeafReader& reader, const RunOptions& options) {
  return std::make_unique<SparseTasks>(reader, options);
}

}  // namespace mc::pipe
