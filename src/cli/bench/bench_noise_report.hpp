// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "cli/bench/bench_noise.hpp"
#include "cli/bench/bench_plan.hpp"

// The figures of `mc bench --noise`. Keys are those of mc-bench(1).

namespace mc::cli {

/// A column a SIMD target.
std::string noises_text(const BenchPlan& plan, const std::vector<NoiseResult>& results);
std::string noises_json(const BenchPlan& plan, const std::vector<NoiseResult>& results);

}  // namespace mc::cli
