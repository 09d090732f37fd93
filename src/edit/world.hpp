// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "edit/edited_samples.hpp"
#include "edit/layer.hpp"

namespace mc::edit {

/// What edits change: samples, and the materials painted on them. A block of materials has a bit in
/// Block::active for each sample that was painted.
struct World {
  explicit World(const VolumeReader& input) : samples(input), materials(sizeof(std::uint16_t)) {}

  EditedSamples samples;
  Layer materials;
};

}  // namespace mc::edit
