// SPDX-License-Identifier: MIT
#include "cli/bench/bench_rounds.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/parallel.hpp"

namespace mc::cli {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

/// One turn: the mean time of `n` runs.
double turn(const TimedBody& body, std::size_t n) {
  const base::ThreadLimit limit(body.threads);
  if (n > 1) body.run();  // a change of threads shows in short bodies
  const auto began = Clock::now();
  for (std::size_t r = 0; r < n; ++r) body.run();
  return seconds_since(began) / static_cast<double>(n);
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

Timing summary(const std::vector<double>& seconds) {
  const double median = median_of(seconds);
  std::vector<double> deviations;
  deviations.reserve(seconds.size());
  for (const double s : seconds) deviations.push_back(std::abs(s - median));
  return {median, *std::min_element(seconds.begin(), seconds.end()), median_of(deviations),
          seconds.size()};
}

}  // namespace

std::vector<Timing> time_rounds(std::span<const TimedBody> bodies, const RoundLimits& limits) {
  constexpr double kLeastTurn = 1e-3;
  std::vector<std::size_t> repeats;
  for (const TimedBody& body : bodies) {
    turn(body, 1);
    repeats.push_back(static_cast<std::size_t>(std::ceil(kLeastTurn / turn(body, 1))));
  }
  std::vector<std::vector<double>> seconds(bodies.size());
  const auto began = Clock::now();
  for (std::size_t round = 0; round < limits.max_rounds; ++round) {
    if (round >= limits.min_rounds && seconds_since(began) > limits.seconds) break;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      seconds[b].push_back(turn(bodies[b], repeats[b]));
    }
  }
  std::vector<Timing> timings;
  timings.reserve(bodies.size());
  for (const auto& times : seconds) timings.push_back(summary(times));
  return timings;
}

}  // namespace mc::cli
