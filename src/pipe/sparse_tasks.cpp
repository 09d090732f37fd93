// SPDX-License-Identifier: MIT
#include <algorithm>

#include "extract/sparse.hpp"
#include "pipe/tasks.hpp"

// Sparse volumes: a task is a run of blocks.

namespace mc::pipe {

namespace {

constexpr std::size_t kBlocksPerTask = 512;

class SparseTasks final : public TaskList {
 public:
  SparseTasks(const LeafReader& reader, const RunOptions& options)
      : plan_(reader, options.extract),
        to_world_(options.to_world.value_or(reader.volume().lattice.to_world)),
        vertex_bytes_((options.extract.precision == Precision::f64 ? 24 : 12) +
                      (options.extract.normals == Normals::none ? 0 : 12)) {}

  void set_slots(std::size_t n_slots) override {
    slots_.clear();
    slots_.reserve(n_slots);
    for (std::size_t s = 0; s < n_slots; ++s) slots_.emplace_back(plan_, to_world_);
  }
  [[nodiscard]] std::size_t n_tasks() const override {
    return (plan_.blocks().size() + kBlocksPerTask - 1) / kBlocksPerTask;
  }
  [[nodiscard]] std::uint64_t samples(std::size_t n) const override {
    return (last(n) - n * kBlocksPerTask) * LeafReader::kLeafSamples;
  }
  void make(std::size_t n, std::size_t slot, TaskResult& out) override {
    slots_[slot].extract(n * kBlocksPerTask, last(n), out.chunk, out.totals);
  }
  void count(std::size_t n, std::size_t slot, TaskResult& out) override {
    slots_[slot].count(n * kBlocksPerTask, last(n), out.totals);
  }
  [[nodiscard]] std::uint64_t held_bytes(std::size_t n_slots) const override {
    return plan_.bytes() + n_slots * extraction::SparseExtractor::scratch_bytes();
  }
  [[nodiscard]] std::uint64_t chunk_bytes() const override {
    return kBlocksPerTask * 128 * (vertex_bytes_ + 24);  // a surface across and back
  }

 private:
  [[nodiscard]] std::size_t last(std::size_t n) const {
    return std::min(plan_.blocks().size(), (n + 1) * kBlocksPerTask);
  }

  extraction::SparsePlan plan_;
  Affine to_world_;
  std::uint64_t vertex_bytes_;
  std::vector<extraction::SparseExtractor> slots_;
};

}  // namespace

std::unique_ptr<TaskList> sparse_tasks(const LeafReader& reader, const RunOptions& options) {
  return std::make_unique<SparseTasks>(reader, options);
}

}  // namespace mc::pipe
