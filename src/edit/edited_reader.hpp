// SPDX-License-Identifier: MIT
#pragma once

#include "edit/edited_samples.hpp"
#include "edit/world.hpp"
#include "mc/field.hpp"

namespace mc::edit {

/// The edited volume's description. Cost   sparse: the stored blocks.
Volume describe(const EditedSamples& samples);

/// The edited volume behind the port of its kind. Keeps a reference; edits must rest.
VolumeReader make_reader(const World& world, const Volume& volume);

/// The samples of a dense volume: the input's planes, copied only where blocks lie in them.
std::unique_ptr<SlabReader> make_slab_reader(const World& world, const Volume& volume);
/// The leaves and tiles of a sparse one: stored blocks are leaves, and tiles that hold one are cut
/// around it.
std::unique_ptr<LeafReader> make_leaf_reader(const World& world, const Volume& volume);

}  // namespace mc::edit
