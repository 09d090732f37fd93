// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "cli/bench/bench_rounds.hpp"

// What memory gives this process: the yardstick of `mc bench`.

namespace mc::cli {

/// Reads all of `data` by the caller's arena, as fast as it can: each thread eight pages at a time,
/// a line of each in turn, which keeps more of them on their way than one stream does.
void read_memory(const std::byte* data, std::size_t n_bytes);

/// Seconds to move `n_bytes` in each way, with some number of threads.
struct Bandwidth {
  int threads = 1;
  std::size_t n_bytes = 0;
  Timing read_one_stream;     ///< front to back
  Timing read_eight_streams;  ///< read_memory()
  Timing write;               ///< plain stores
  Timing write_past_cache;    ///< stores that do not read the line first
  Timing touch_small;         ///< fresh pages of 4 KiB: written once, given back
  Timing touch_huge;          ///< the same, huge pages asked for

  /// Bytes a second of the faster way to read.
  [[nodiscard]] double read() const;
};

inline constexpr std::size_t kBandwidthBytes = std::size_t{256} << 20;  ///< past any cache

/// Measures with each of the given numbers of threads.
/// Errors   std::bad_alloc: no room for kBandwidthBytes, twice.
std::vector<Bandwidth> measure_bandwidth(const std::vector<int>& threads,
                                         const RoundLimits& limits);

}  // namespace mc::cli
