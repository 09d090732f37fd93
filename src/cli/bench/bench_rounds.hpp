// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

// Timing in rounds: every body once a round, one after the other, so that what disturbs the machine
// disturbs all of them alike.

namespace mc::cli {

struct RoundLimits {
  std::size_t min_rounds = 10;
  std::size_t max_rounds = 1000;
  double seconds = 1;  ///< no more rounds once so much has passed, but min_rounds
};

/// A body to time, and the threads it may use.
struct TimedBody {
  int threads = 1;
  std::function<void()> run;
};

/// Times of one body over the rounds, in seconds.
struct Timing {
  double median = 0;
  double least = 0;
  double spread = 0;  ///< median absolute deviation
  std::size_t n_rounds = 0;
};

/// Runs each body once to warm it up, then all of them in rounds. One that takes less than a
/// millisecond is repeated within its turn, and its time is the turn's by their number.
std::vector<Timing> time_rounds(std::span<const TimedBody> bodies, const RoundLimits& limits);

}  // namespace mc::cli
