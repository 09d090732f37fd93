// SPDX-License-Identifier: MIT
#include "pipe/label_components.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "extract/cubes/slab_labeller.hpp"
#include "extract/sparse/sparse_components.hpp"
#include "pipe/dense_planes.hpp"
#include "pipe/room.hpp"
#include "pipe/tasks.hpp"

// The first of the two passes of a run that keeps some components only.

namespace mc::pipe {

namespace {

using extraction::RunSize;
using extraction::RunTable;
using extraction::SlabLabeller;
using extraction::SlabLabels;
using extraction::SparseComponents;

/// Samples of a slab of labels, and its layers.
constexpr std::uint64_t kSlabSamples = 1U << 21U;
constexpr std::int32_t kMinLayers = 4;
constexpr std::int32_t kMaxLayers = 64;
constexpr std::size_t kBlocksPerTask = 512;

Error too_little_memory(std::uint64_t bytes, const RunOptions& options) {
  return {ErrorKind::limit,
          {},
          "to tell components apart takes more than " + mebibytes(bytes) + ", but only " +
              mebibytes(options.memory_bytes) + " are allowed",
          Remedy::more_memory};
}

/// Options of the pass that labels.
RunOptions labelling_options(RunOptions options) {
  options.extract = extraction::labelling_options(options.extract);
  return options;
}

/// The labelling of one dense volume.
class DenseLabelling {
 public:
  DenseLabelling(const PlaneInput& input, const RunOptions& options, Progress& progress,
                 const std::stop_token& stop)
      : options_(options),
        progress_(progress),
        stop_(stop),
        planes_(input, labelling_options(options)),
        to_world_(options.to_world.value_or(input.volume().lattice.to_world)),
        first_(labeller()) {}

  SelectedComponents select();

 private:
  struct Slot {
    SlabLabeller labeller;
    Slab slab;
    SlabLabels labels;
  };

  [[nodiscard]] SlabLabeller labeller() const {
    return {planes_.input.volume(), to_world_, options_.extract,
            extraction::size_kind_of(options_.keep.value())};
  }
  [[nodiscard]] std::uint64_t slot_bytes(std::int32_t layers) const {
    const std::uint64_t planes = planes_.input.rereads_cheaply()
                                     ? 0
                                     : static_cast<std::uint64_t>(layers + 1) * planes_.plane_bytes;
    return planes + first_.max_bytes(layers);
  }
  void fit();
  void label();
  void add(const SlabLabels& labels, bool is_last);

  const RunOptions& options_;
  Progress& progress_;
  const std::stop_token& stop_;
  DensePlanes planes_;
  Affine to_world_;
  SlabLabeller first_;        ///< answers for all
  std::uint64_t budget_ = 0;  ///< for slabs and labels
  std::size_t n_slots_ = 1;
  std::int32_t layers_ = 1;
  RunTable table_;
};

/// Half of the budget at most is for slabs, the rest for labels.
void DenseLabelling::fit() {
  const std::uint64_t own = memory_beside(planes_.input.held_bytes(), options_.memory_bytes);
  if (own < kProgramBytes + slot_bytes(1)) {
    throw too_little_memory(planes_.input.held_bytes() + kProgramBytes + slot_bytes(1), options_);
  }
  budget_ = own - kProgramBytes;
  const auto wanted = static_cast<std::int32_t>(
      std::clamp<std::uint64_t>(kSlabSamples / planes_.n_samples, kMinLayers, kMaxLayers));
  layers_ = std::min(wanted, first_.n_layers());
  n_slots_ = base::pipeline_slots();
  while (layers_ > 1 && slot_bytes(layers_) * n_slots_ > budget_ / 2) layers_ = (layers_ + 1) / 2;
  while (n_slots_ > 1 && slot_bytes(layers_) * n_slots_ > budget_ / 2) n_slots_ /= 2;
}

void DenseLabelling::add(const SlabLabels& labels, bool is_last) {
  table_.add(labels, is_last);
  const std::uint64_t slabs = n_slots_ * slot_bytes(layers_);
  if (table_.bytes() + std::min(slabs, budget_ / 2) > budget_) {
    throw too_little_memory(planes_.input.held_bytes() + kProgramBytes + table_.bytes() + slabs,
                            options_);
  }
}

void DenseLabelling::label() {
  const auto n_tasks = static_cast<std::size_t>((first_.n_layers() + layers_ - 1) / layers_);
  const auto begin = [&](std::size_t n) { return static_cast<std::int32_t>(n) * layers_; };
  const auto end = [&](std::size_t n) { return std::min(first_.n_layers(), begin(n) + layers_); };
  std::vector<Slot> slots;
  for (std::size_t n = 0; n < n_slots_; ++n) slots.push_back({labeller(), {}, {}});
  const std::array<base::Step, 2> steps{{
      {false,
       [&](std::size_t n, std::size_t slot) {
         if (stop_.stop_requested()) throw Cancelled();
         Slot& s = slots[slot];
         const auto [k0, k1] = s.labeller.planes_for(begin(n), end(n));
         planes_.read(k0, k1, s.slab);
         s.labeller.label(s.slab, begin(n), end(n), s.labels);
       }},
      {true,
       [&](std::size_t n, std::size_t slot) {
         add(slots[slot].labels, n + 1 == n_tasks);
         progress_.advance(planes_.n_samples * static_cast<std::uint64_t>(end(n) - begin(n)));
       }},
  }};
  base::pipeline(n_tasks, n_slots_, steps);
}

SelectedComponents DenseLabelling::select() {
  fit();
  progress_.begin("label", planes_.n_samples * static_cast<std::uint64_t>(first_.n_layers()),
                  "samples");
  label();
  std::vector<double> sizes;
  for (const std::uint64_t sum : table_.number_components()) {
    sizes.push_back(first_.unit().size_of(sum));
  }
  // A solid layer around the volume is part of the first component, which has no end.
  if (options_.extract.border == Border::solid) {
    sizes.front() = std::numeric_limits<double>::infinity();
  }
  const std::vector<std::uint8_t> kept = select_components(sizes, *options_.keep);
  const auto starts = table_.plane_starts();
  return {ComponentSelection(
              extraction::DenseSelection(first_.first_plane(), {starts.begin(), starts.end()},
                                         table_.kept(kept), options_.extract.inside)),
          {kept.size(), static_cast<std::uint64_t>(std::ranges::count(kept, 1))}};
}

SelectedComponents select_sparse(const LeafReader& reader, const RunOptions& options,
                                 Progress& progress, const std::stop_token& stop) {
  const std::uint64_t budget = memory_beside(reader.held_bytes(), options.memory_bytes);
  SparseComponents components(reader, options.to_world.value_or(reader.volume().lattice.to_world),
                              options.extract, extraction::size_kind_of(*options.keep));
  if (kProgramBytes + components.bytes() > budget) {
    throw too_little_memory(reader.held_bytes() + kProgramBytes + components.bytes(), options);
  }
  const std::size_t n_blocks = components.n_blocks();
  progress.begin("label", n_blocks * LeafReader::kLeafSamples, "samples");
  std::vector<std::vector<RunSize>> sizes(base::pipeline_slots());
  const auto last = [&](std::size_t n) { return std::min(n_blocks, (n + 1) * kBlocksPerTask); };
  const std::array<base::Step, 2> steps{{
      {false,
       [&](std::size_t n, std::size_t slot) {
         if (stop.stop_requested()) throw Cancelled();
         components.measure(n * kBlocksPerTask, last(n), sizes[slot]);
       }},
      {true,
       [&](std::size_t n, std::size_t slot) {
         components.add(sizes[slot]);
         progress.advance((last(n) - n * kBlocksPerTask) * LeafReader::kLeafSamples);
       }},
  }};
  base::pipeline((n_blocks + kBlocksPerTask - 1) / kBlocksPerTask, sizes.size(), steps);
  const std::vector<std::uint8_t> kept = select_components(components.sizes(), *options.keep);
  return {ComponentSelection(components.selection(kept)),
          {kept.size(), static_cast<std::uint64_t>(std::ranges::count(kept, 1))}};
}

}  // namespace

SelectedComponents label_and_select(const VolumeReader& reader, const RunOptions& options,
                                    Progress& progress, const std::stop_token& stop) {
  const Method& method = method_of(options.extract);
  if (!method.selects_components) {
    throw Error(ErrorKind::usage, "keep",
                "the method " + std::string(method.name) + " cannot leave out components");
  }
  if (is_dense(reader)) {
    return DenseLabelling(PlaneInput::of(reader), options, progress, stop).select();
  }
  return select_sparse(*std::get<std::unique_ptr<LeafReader>>(reader), options, progress, stop);
}

}  // namespace mc::pipe
