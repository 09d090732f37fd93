// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>

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

/// Calls body(begin, end) for disjoint ranges that cover [0, n), ranges of at least `grain`, on
/// several threads. Serial when n <= grain. The first exception of a body comes out.
void for_ranges(std::size_t n, std::size_t grain,
                const std::function<void(std::size_t, std::size_t)>& body);

/// Items 0..n-1: work(item, slot) on several threads, then consume(item, slot) one at a time and in
/// order. At most `n_slots` items are between the start of their work and the end of their
/// consumption, and each has its slot in [0, n_slots) to itself meanwhile: scratch lives there.
/// The first exception of either comes out, after all that runs has ended.
void ordered_pipeline(std::size_t n_items, std::size_t n_slots,
                      const std::function<void(std::size_t, std::size_t)>& work,
                      const std::function<void(std::size_t, std::size_t)>& consume);

}  // namespace mc::base
