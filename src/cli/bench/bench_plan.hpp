// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/arguments/args.hpp"
#include "cli/bench/bench_rounds.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"

namespace mc::cli {

/// What `mc bench` was asked for.
struct BenchPlan {
  std::vector<std::string> fields;
  std::int32_t n_samples = 256;  ///< along each axis
  SampleType type = SampleType::f32;
  Normals normals = Normals::none;
  std::vector<int> threads;  ///< each at least 1
  RoundLimits limits;
  bool json = false;
  bool noise = false;  ///< noises, not fields; n_samples is then their terrains' longest axis
};

/// Errors   usage.
BenchPlan resolve(const BenchArgs& args);

/// Bytes that the plan's largest field needs, with its mesh, while it is timed.
double bench_bytes(const BenchPlan& plan);

/// Refuses a plan that this machine's free memory cannot hold. Errors   limit.
void check_bench_memory(const BenchPlan& plan);

}  // namespace mc::cli
