// SPDX-License-Identifier: MIT
#pragma once

#include "cli/arguments/resolve.hpp"
#include "cli/invocation.hpp"
#include "cli/messages/report_file.hpp"

// The jobs of `mc extract`: one, or a batch of them.

namespace mc::cli {

/// Runs all jobs of a plan; one that fails stops no other. What each says and reports comes in the
/// order of the jobs. Returns the exit status of the first that failed.
/// Threads  small files are done several at once, one thread each; others one by one, on all.
int run_jobs(const ExtractPlan& plan, Invocation& invocation, ReportFile& file);

}  // namespace mc::cli
