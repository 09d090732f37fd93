// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <span>

// The one door to threads. Two back ends, chosen when the library is built: oneTBB, and plain
// std::thread for ThreadSanitizer, which cannot see through a stock TBB.

namespace mc::base {

/// Threads that the caller's arena offers.
[[nodiscard]] int thread_count();

/// Limits the threads of everything below it in time; made once, by the command line.
class ThreadLimit {
 public:
  explicit ThreadLimit(int n_threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  void* control_ = nullptr;
};

/// Does the work with one thread, whatever runs beside it: in it thread_count() is 1.
void alone(const std::function<void()>& work);

/// Calls body(begin, end) for disjoint ranges that cover [0, n), ranges of at least `grain`, on
/// several threads. Serial when n <= grain. The first exception of a body comes out.
void for_ranges(std::size_t n, std::size_t grain,
                const std::function<void(std::size_t, std::size_t)>& body);

/// One step of a pipeline. `in_order`: one item at a time, from the first to the last; else on
/// several threads at once.
struct Step {
  bool in_order = false;
  std::function<void(std::size_t item, std::size_t slot)> run;
};

/// Slots that keep all threads at work while items wait for their turn.
[[nodiscard]] std::size_t pipeline_slots();

/// Takes items 0..n-1 through all steps, each item through one after the other. At most `n_slots`
/// items are on their way, and each has its slot in [0, n_slots) to itself from its first step to
/// its last: scratch lives there. A step in order should be short. One thread takes the items one
/// by one, all in slot 0, and allocates nothing.
/// The first exception of a step comes out, after all that runs has ended.
void pipeline(std::size_t n_items, std::size_t n_slots, std::span<const Step> steps);

}  // namespace mc::base
