// SPDX-License-Identifier: MIT
#include "edit/edited_reader.hpp"

// What the edited volume says of itself, whatever its kind.

namespace mc::edit {

namespace {

IndexBox active_box(const EditedSamples& samples, std::uint64_t& n_active) {
  const bool filled = samples.filled().has_value();
  const Volume& input = samples.input().volume();
  IndexBox box = filled ? IndexBox{} : input.lattice.box;
  n_active = filled ? 0 : input.n_active.value_or(0);
  for (const auto& [at, block] : samples.layer().blocks()) {
    box = joined(box, box_of(at, block->active));
    n_active += n_ones(block->active);
    n_active -= n_ones(samples.base_active(at));
  }
  return box;
}

}  // namespace

Volume describe(const EditedSamples& samples) {
  Volume out = samples.input().volume();
  if (samples.input().leaves() == nullptr) return out;
  std::uint64_t n_active = 0;
  out.lattice.box = active_box(samples, n_active);
  if (out.n_active) out.n_active = n_active;
  return out;
}

VolumeReader make_reader(const World& world, const Volume& volume) {
  if (world.samples.input().leaves() != nullptr) return make_leaf_reader(world, volume);
  return make_slab_reader(world, volume);
}

}  // namespace mc::edit
