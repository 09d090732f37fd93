// SPDX-License-Identifier: MIT
#include "edit/brush_pass.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

#include "base/parallel.hpp"
#include "edit/neighbourhood.hpp"

// One pass of a brush: weights, operands, arithmetic, block by block.

namespace mc::edit {

namespace {

/// Blocks that one thread takes at a time.
constexpr std::size_t kGrain = 16;

using BlockBytes = std::array<std::byte, kBlockSamples * sizeof(std::uint64_t)>;

/// Bits of the samples of a row that differ.
std::uint64_t differing(const std::byte* a, const std::byte* b, std::size_t sample_bytes) {
  std::uint64_t bits = 0;
  if (std::memcmp(a, b, kBlockSize * sample_bytes) == 0) return bits;
  for (std::size_t i = 0; i < kBlockSize; ++i) {
    const std::size_t at = i * sample_bytes;
    bits |= std::uint64_t{std::memcmp(a + at, b + at, sample_bytes) != 0} << i;
  }
  return bits;
}

void join(Mask512& mask, const Mask512& other) {
  for (std::size_t k = 0; k < mask.size(); ++k) mask[k] |= other[k];
}

}  // namespace

BrushPass::BrushPass(const Edit& edit, const EditRules& rules, const Stroke& stroke, World& world)
    : edit_(edit),
      rules_(rules),
      stroke_(stroke),
      world_(world),
      weigher_(stroke, edit, rules),
      operands_(edit, rules, world.samples),
      recipe_(recipe_of(edit, rules)) {
  effect_.n_dabs = stroke.n_groups;
  effect_.n_outside = stroke.n_outside;
}

Layer& BrushPass::layer() const {
  return edit_.op == EditOp::paint ? world_.materials : world_.samples.layer();
}

void BrushPass::plan(std::uint32_t first, std::uint32_t last, std::uint64_t most_blocks) {
  touches_.emplace(stroke_, first, last, most_blocks);
}

bool BrushPass::find_plane() {
  if (edit_.op != EditOp::flatten) return true;
  if (edit_.plane) {
    operands_.set_plane(*edit_.plane);
    return true;
  }
  std::vector<SurfaceSums> sums(touches_->size());
  base::for_ranges(sums.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    BlockWeights weights;
    for (std::size_t n = begin; n < end; ++n) {
      const Index3& at = touches_->block(n);
      if (!weigher_.weigh(at, touches_->positions(n), weights)) continue;
      sums[n] = sum_surface(rules_, world_.samples, at, weights);
    }
  });
  SurfaceSums all;
  for (const SurfaceSums& part : sums) all.add(part);
  const std::optional<FlattenPlane> plane = all.plane(rules_.above);
  if (plane) operands_.set_plane(*plane);
  return plane.has_value();
}

void BrushPass::load(const Index3& at, Block& out) const {
  const Layer& blocks = layer();
  if (const Block* stored = blocks.find(at)) {
    std::memcpy(out.samples(), stored->samples(), kBlockSamples * blocks.sample_bytes());
    out.active = stored->active;
  } else if (edit_.op == EditOp::paint) {
    std::memset(out.samples(), 0, kBlockSamples * blocks.sample_bytes());
  } else {
    world_.samples.read_base(at, out.samples());
    if (world_.samples.input().leaves() != nullptr) out.active = world_.samples.base_active(at);
  }
}

void BrushPass::work(const Index3& at, std::span<const std::uint32_t> group, std::uint32_t steps,
                     BlockWeights& weights, Block& block) const {
  const SampleType type = world_.samples.type();
  if (edit_.op == EditOp::paint) {
    auto* materials = reinterpret_cast<std::uint16_t*>(block.samples());
    for (std::size_t n = 0; n < kBlockSamples; ++n) {
      const bool reached = (weights.reached[n / 64] >> (n % 64) & 1U) != 0;
      if (!reached || weights.weight[n] < 0.5) continue;
      materials[n] = edit_.material;
      block.active[n / 64] |= std::uint64_t{1} << (n % 64);
    }
    return;
  }
  if (edit_.op == EditOp::revert) {
    alignas(64) BlockBytes input;
    world_.samples.input().read_block(at, input.data());
    const Mask512 whole =
        restore(edit_.strength, steps, weights, type, input.data(), block.samples());
    if (world_.samples.input().leaves() == nullptr) return;
    const Mask512 active = world_.samples.input().read_active(at);
    for (std::size_t k = 0; k < whole.size(); ++k) {
      block.active[k] = (block.active[k] & ~whole[k]) | (active[k] & whole[k]);
    }
    return;
  }
  alignas(64) std::array<double, kBlockSamples> operand;
  operands_.find(at, stroke_.positions[group.front()], weights, operand);
  Recipe recipe = recipe_;
  recipe.steps = steps;
  combine(recipe, weights, operand, type, block.samples());
}

void BrushPass::compare(const std::byte* before, const Mask512& active_before, Outcome& out) const {
  const std::size_t size = layer().sample_bytes();
  const std::byte* after = out.block->samples();
  for_rows_of(out.marks.reached, [&](std::size_t row) {
    const std::size_t at = row * kBlockSize * size;
    out.marks.changed[row / kBlockSize] |= differing(before + at, after + at, size)
                                           << (row % kBlockSize * kBlockSize);
  });
  if (edit_.op == EditOp::paint) {  // the first paint is a change, also by the material 0
    for (std::size_t k = 0; k < kBlockSize; ++k) {
      out.marks.changed[k] |= out.block->active[k] & ~active_before[k];
    }
  }
  out.changed = n_ones(out.marks.changed) != 0;
  if (edit_.op == EditOp::paint || world_.samples.input().leaves() == nullptr) return;
  if (edit_.op != EditOp::revert && out.changed) {
    alignas(64) BlockBytes row;
    fill_samples(row.data(), kBlockSize, world_.samples.background(), size);
    for_rows_of(out.marks.changed, [&](std::size_t n) {
      const std::uint64_t bits = differing(row.data(), after + n * kBlockSize * size, size);
      out.block->active[n / kBlockSize] |=
          out.marks.changed[n / kBlockSize] & bits << (n % kBlockSize * kBlockSize);
    });
  }
  out.changed = out.changed || out.block->active != active_before;
}

void BrushPass::apply(std::size_t n, std::uint32_t steps, Outcome& out) const {
  const Index3& at = touches_->block(n);
  BlockWeights weights;
  alignas(64) BlockBytes before;
  Mask512 active{};
  bool loaded = false;
  for_groups_of(stroke_, touches_->positions(n), [&](std::span<const std::uint32_t> group) {
    if (!weigher_.weigh(at, group, weights)) return;
    if (!loaded) {
      load(at, *out.block);
      std::memcpy(before.data(), out.block->samples(), kBlockSamples * layer().sample_bytes());
      active = out.block->active;
      loaded = true;
    }
    work(at, group, steps, weights, *out.block);
    join(out.marks.reached, weights.reached);
  });
  if (loaded) compare(before.data(), active, out);
}

void BrushPass::run(std::uint32_t steps, History& history) {
  Layer& blocks = layer();
  std::vector<Outcome> outcomes(touches_->size());
  for (Outcome& outcome : outcomes) outcome.block = blocks.pool().take();
  try {
    base::for_ranges(outcomes.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) apply(n, steps, outcomes[n]);
    });
  } catch (...) {
    for (Outcome& outcome : outcomes) blocks.pool().give_back(std::move(outcome.block));
    throw;
  }
  for (std::size_t n = 0; n < outcomes.size(); ++n) {
    Outcome& outcome = outcomes[n];
    note(touches_->block(n), outcome.marks);
    if (outcome.changed) {
      history.put(blocks, touches_->block(n), std::move(outcome.block));
    } else {
      blocks.pool().give_back(std::move(outcome.block));
    }
  }
}

void BrushPass::measure() {
  BlockWeights weights;
  for (std::size_t n = 0; n < touches_->size(); ++n) {
    Marks marks;
    const Index3& at = touches_->block(n);
    for_groups_of(stroke_, touches_->positions(n), [&](std::span<const std::uint32_t> group) {
      if (!weigher_.weigh(at, group, weights)) return;
      if (edit_.op == EditOp::stamp) {
        std::array<double, kBlockSamples> operand;
        operands_.find(at, stroke_.positions[group.front()], weights, operand);
      }
      join(marks.reached, weights.reached);
    });
    effect_.n_samples += n_ones(marks.reached);
    effect_.touched = joined(effect_.touched, box_of(at, marks.reached));
  }
}

void BrushPass::note(const Index3& at, const Marks& marks) {
  effect_.touched = joined(effect_.touched, box_of(at, marks.changed));
  if (!looks_around(edit_.op)) {
    effect_.n_samples += n_ones(marks.reached);
    effect_.n_changed += n_ones(marks.changed);
    return;
  }
  Marks& all = noted_[at];
  effect_.n_samples -= n_ones(all.reached);
  effect_.n_changed -= n_ones(all.changed);
  join(all.reached, marks.reached);
  join(all.changed, marks.changed);
  effect_.n_samples += n_ones(all.reached);
  effect_.n_changed += n_ones(all.changed);
}

}  // namespace mc::edit
