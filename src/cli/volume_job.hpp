// SPDX-License-Identifier: MIT
#pragma once

#include "cli/invocation.hpp"
#include "cli/resolve.hpp"
#include "mc/field.hpp"

// One volume to one volume file.

namespace mc::cli {

/// Writes the samples, or those of the plan's region, to the plan's output.
void write_volume(const VolumeReader& from, const SamplePlan& plan, Invocation& invocation);

}  // namespace mc::cli
