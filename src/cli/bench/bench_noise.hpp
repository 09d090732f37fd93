// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cli/bench/bench_rounds.hpp"

// What `mc bench --noise` measures: noises over rows of places, and terrains from the graph to the
// mesh, on one thread and every SIMD target, beside the core's clock.

namespace mc::cli {

/// One body on one SIMD target.
struct NoiseResult {
  std::string name;
  std::string simd;
  std::uint64_t n_points = 0;  ///< noise values, or samples of a terrain
  Timing time;                 ///< its least counts: what disturbs only adds
  double clock = 0;            ///< of the core, in Hz, in the same rounds
  double published = 0;        ///< FastNoise2's values a cycle; 0: it publishes none

  [[nodiscard]] double points_a_second() const {
    return static_cast<double>(n_points) / time.least;
  }
  [[nodiscard]] double by_published() const { return points_a_second() / clock / published; }
};

/// All bodies on every target of this machine, target by target. A terrain has n x n/2 x n samples.
std::vector<NoiseResult> measure_noises(std::int32_t n, const RoundLimits& limits);

}  // namespace mc::cli
