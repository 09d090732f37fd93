// SPDX-License-Identifier: MIT
#pragma once

#include <stop_token>

#include "extract/components/selection.hpp"
#include "mc/components.hpp"
#include "mc/pipe.hpp"

namespace mc::pipe {

/// Components of a run that remain, and how many there are.
struct SelectedComponents {
  ComponentSelection selection;
  ComponentCounts counts;
};

/// Tells the components of a volume apart by a pass over all samples, and applies options.keep.
/// Precondition: `reader` is no stream.
/// Errors   usage: a method that cannot leave out components; limit: labels need more than
///          options.memory_bytes; those of the reader.
/// Threads  uses the caller's arena; the result does not depend on the thread count.
/// Cost     dense: 4 bytes a run of solid samples and 12 a component; sparse: 4 bytes a run, 80 a
///          block with both kinds of samples.
SelectedComponents label_and_select(const VolumeReader& reader, const RunOptions& options,
                                    Progress& progress, const std::stop_token& stop);

}  // namespace mc::pipe
