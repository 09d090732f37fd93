// SPDX-License-Identifier: MIT
#include "base/parallel.hpp"

#include <algorithm>
#include <exception>

#if MC_THREADS_STD
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>
#else
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#endif

namespace mc::base {

#if MC_THREADS_STD

namespace {

std::atomic<int> limit{0};

/// Runs `body` on n threads, the caller's among them, and rethrows the first exception.
void on_threads(int n, const std::function<void()>& body) {
  std::mutex mutex;
  std::exception_ptr fault;
  const auto guarded = [&] {
    try {
      body();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!fault) fault = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int t = 1; t < n; ++t) threads.emplace_back(guarded);
    guarded();
  }
  if (fault) std::rethrow_exception(fault);
}

}  // namespace

int thread_count() {
  const int asked = limit.load();
  return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

ThreadLimit::ThreadLimit(int n_threads) { limit = n_threads; }
ThreadLimit::~ThreadLimit() { limit = 0; }

void for_ranges(std::size_t n, std::size_t grain,
                const std::function<void(std::size_t, std::size_t)>& body) {
  if (n == 0) return;
  if (n <= grain || thread_count() == 1) {
    body(0, n);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::atomic<bool> failed{false};
  on_threads(thread_count(), [&] {
    for (;;) {
      const std::size_t begin = next.fetch_add(grain);
      if (begin >= n || failed) return;
      try {
        body(begin, std::min(n, begin + grain));
      } catch (...) {
        failed = true;
        throw;
      }
    }
  });
}

void ordered_pipeline(std::size_t n_items, std::size_t n_slots,
                      const std::function<void(std::size_t, std::size_t)>& work,
                      const std::function<void(std::size_t, std::size_t)>& consume) {
  std::mutex mutex;
  std::condition_variable changed;
  std::size_t next = 0;
  std::size_t consumed = 0;
  bool failed = false;
  const auto take = [&](std::size_t& item) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return failed || next >= n_items || next - consumed < n_slots; });
    if (failed || next >= n_items) return false;
    item = next++;
    return true;
  };
  const auto in_turn = [&](std::size_t item) {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return failed || consumed == item; });
    return !failed;
  };
  on_threads(std::min<int>(thread_count(), static_cast<int>(n_slots)), [&] {
    try {
      for (std::size_t item = 0; take(item);) {
        work(item, item % n_slots);
        if (!in_turn(item)) return;
        consume(item, item % n_slots);
        {
          const std::lock_guard lock(mutex);
          ++consumed;
        }
        changed.notify_all();
      }
    } catch (...) {
      {
        const std::lock_guard lock(mutex);
        failed = true;
      }
      changed.notify_all();
      throw;
    }
  });
}

#else

int thread_count() {
  const auto allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::max(1, std::min(tbb::this_task_arena::max_concurrency(), static_cast<int>(allowed)));
}

ThreadLimit::ThreadLimit(int n_threads)
    : control_(new tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                       static_cast<std::size_t>(std::max(1, n_threads)))) {}
ThreadLimit::~ThreadLimit() { delete static_cast<tbb::global_control*>(control_); }

void for_ranges(std::size_t n, std::size_t grain,
                const std::function<void(std::size_t, std::size_t)>& body) {
  if (n == 0) return;
  if (n <= grain) {
    body(0, n);
    return;
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, grain),
                    [&](const tbb::blocked_range<std::size_t>& r) { body(r.begin(), r.end()); });
}

void ordered_pipeline(std::size_t n_items, std::size_t n_slots,
                      const std::function<void(std::size_t, std::size_t)>& work,
                      const std::function<void(std::size_t, std::size_t)>& consume) {
  // Items start and end in order and at most n_slots are alive, so the live ones are consecutive
  // and item % n_slots is theirs alone.
  std::size_t next = 0;
  const auto start = tbb::make_filter<void, std::size_t>(
      tbb::filter_mode::serial_in_order, [&](tbb::flow_control& control) -> std::size_t {
        if (next >= n_items) {
          control.stop();
          return 0;
        }
        return next++;
      });
  const auto middle =
      tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel, [&](std::size_t item) {
        work(item, item % n_slots);
        return item;
      });
  const auto end = tbb::make_filter<std::size_t, void>(
      tbb::filter_mode::serial_in_order, [&](std::size_t item) { consume(item, item % n_slots); });
  tbb::parallel_pipeline(n_slots, start & middle & end);
}

#endif

}  // namespace mc::base
