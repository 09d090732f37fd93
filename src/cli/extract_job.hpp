// SPDX-License-Identifier: MIT
#pragma once

#include "cli/invocation.hpp"
#include "cli/report.hpp"
#include "cli/resolve.hpp"
#include "mc/source.hpp"

// One volume to one mesh.

namespace mc::cli {

/// Runs `job` of `plan`, or with --dry-run says what it would do; fills `report` as far as it
/// comes, also when it throws.
void run_job(const ExtractPlan& plan, const Job& job, Invocation& invocation, RunReport& report);

/// The same over a volume that is open already.
void run_open_job(const ExtractPlan& plan, const std::string& output, const Source& source,
                  Invocation& invocation, RunReport& report);

}  // namespace mc::cli
