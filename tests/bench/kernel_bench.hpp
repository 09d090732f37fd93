// SPDX-License-Identifier: MIT
#pragma once

#include <benchmark/benchmark.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "base/simd_target.hpp"

// What the benchmarks of kernels share: each is run on every SIMD target of this machine, and on
// each is first compared with a plain twin; a kernel that differs is reported and not timed.

namespace mc::bench {

/// Runs once for each turn of the clock.
using Kernel = std::function<void()>;

/// Registers NAME/TARGET for each target. `n_items` are what a run handles, named `items` (cells,
/// samples); `right` says whether the kernel's result, once it has run, is that of its twin.
inline void add_kernel(const std::string& name, const std::string& items, double n_items,
                       const Kernel& kernel, const std::function<bool()>& right) {
  for (const std::string& target : base::simd_targets()) {
    benchmark::RegisterBenchmark((name + "/" + target).c_str(), [=](benchmark::State& state) {
      base::set_simd_target(target);
      kernel();
      if (!right()) state.SkipWithError("differs from its plain twin");
      for ([[maybe_unused]] auto _ : state) {
        kernel();
        benchmark::ClobberMemory();
      }
      state.counters[items + "/s"] = benchmark::Counter(
          n_items * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
      base::reset_simd_target();
    })->Unit(benchmark::kMicrosecond);
  }
}

inline constexpr std::int32_t kSide = 512;  ///< samples of a row, and rows of a plane

/// Plane k of a gyroid of eight periods in kSide^3 samples; within [-1, 1].
inline std::vector<double> gyroid_plane(std::int32_t k) {
  const auto angle = [](std::int32_t n) { return 16 * std::numbers::pi * n / (kSide - 1); };
  std::vector<double> plane;
  const double z = angle(k);
  for (std::int32_t j = 0; j < kSide; ++j) {
    const double y = angle(j);
    for (std::int32_t i = 0; i < kSide; ++i) {
      const double x = angle(i);
      plane.push_back(
          (std::sin(x) * std::cos(y) + std::sin(y) * std::cos(z) + std::sin(z) * std::cos(x)) / 2);
    }
  }
  return plane;
}

/// One file's kernels.
void add_classification();
void add_cells();
void add_vertices();
void add_noises();
void add_chunks();
void add_edits();

}  // namespace mc::bench
