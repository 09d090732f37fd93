// SPDX-License-Identifier: MIT
#pragma once

#include <openvdb/Grid.h>

#include <memory>

#include "mc/field.hpp"

namespace mc::sink {

/// Grows the tree of one grid. What kind of grid it is shows only in here.
class GridBuilder {
 public:
  virtual ~GridBuilder() = default;
  virtual void add(const Slab& slab) = 0;
  virtual void add(const LeafReader& reader) = 0;
  /// The grid, without transform and metadata.
  virtual openvdb::GridBase::Ptr finish() = 0;
};

std::unique_ptr<GridBuilder> grid_builder_for(const Volume& volume);

/// Whether small values are solid, as in level sets.
[[nodiscard]] bool below_is_solid(VolumeClass cls);

}  // namespace mc::sink
