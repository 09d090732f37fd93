// SPDX-License-Identifier: MIT
#pragma once

#include "cli/invocation.hpp"
#include "cli/resolve.hpp"
#include "mc/field.hpp"

namespace mc::cli {

/// Writes the plane that plan.slice chooses, as it is seen with the first axis to the right and the
/// second up: i, j for a plane of constant k; k, j for i; i to the right and k down for j (y is up,
/// so that is the view from above). PNG: greys from --range, or the finite range of the slice.
/// Errors   usage: outside the volume, a world axis that is no axis of the samples.
void write_slice(const VolumeReader& from, const SamplePlan& plan, Invocation& invocation);

}  // namespace mc::cli
