// SPDX-License-Identifier: MIT
#pragma once

#include "mc/graph.hpp"

namespace mc::edit {

/// A graph's values at the places of lattice indices first + (0..dims-1) under a map, computed in
/// double and rounded to float.
/// Cost     as GraphField::sample() where the map's axes are those of the coordinates; else a
///          compiled graph is set up for each sample.
void sample_places(const GraphField& field, const Affine& to_place, const Index3& first,
                   View3<float> out);

}  // namespace mc::edit
