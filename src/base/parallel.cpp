// SPDX-License-Identifier: MIT
#include "base/parallel.hpp"

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

#if MC_THREADS_STD
#include <atomic>
#include <condition_variable>
#include <exception>
#include <thread>
#else
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>
#endif

namespace mc::base {

namespace {

/// The items on their way and the slots that are free, the last one used first: its memory is
/// nearest.
class Slots {
 public:
  explicit Slots(std::size_t n) : item_(n) {
    for (std::size_t slot = n; slot-- > 0;) free_.push_back(slot);
  }
  [[nodiscard]] bool any_free() const { return !free_.empty(); }
  std::size_t take(std::size_t item) {
    const std::lock_guard lock(mutex_);
    const std::size_t slot = free_.back();
    free_.pop_back();
    item_[slot] = item;
    return slot;
  }
  void give_back(std::size_t slot) {
    const std::lock_guard lock(mutex_);
    free_.push_back(slot);
  }
  [[nodiscard]] std::size_t item(std::size_t slot) const { return item_[slot]; }

 private:
  std::mutex mutex_;
  std::vector<std::size_t> free_;
  std::vector<std::size_t> item_;
};

}  // namespace

#if MC_THREADS_STD

namespace {

std::atomic<int> limit{0};
thread_local bool is_alone = false;

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
  if (is_alone) return 1;
  const int asked = limit.load();
  return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

ThreadLimit::ThreadLimit(int n_threads) { limit = n_threads; }
ThreadLimit::~ThreadLimit() { limit = 0; }

void alone(const std::function<void()>& work) {
  struct Alone {
    bool before = std::exchange(is_alone, true);
    ~Alone() { is_alone = before; }
  } const guard;
  work();
}

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

namespace {

/// Several threads, each of which carries an item through all steps.
class Carriers {
 public:
  Carriers(std::size_t n_items, std::size_t n_slots, std::span<const Step> steps)
      : n_items_(n_items), steps_(steps), passed_(steps.size()), slots_(n_slots) {}

  void carry() {
    try {
      for (std::size_t slot = 0; take(slot);) {
        for (std::size_t s = 0; s < steps_.size(); ++s) {
          if (!in_turn(s, slots_.item(slot))) return;
          steps_[s].run(slots_.item(slot), slot);
          if (steps_[s].in_order) change([&] { ++passed_[s]; });
        }
        change([&] { slots_.give_back(slot); });
      }
    } catch (...) {
      change([&] { failed_ = true; });
      throw;
    }
  }

 private:
  bool take(std::size_t& slot) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return failed_ || next_ >= n_items_ || slots_.any_free(); });
    if (failed_ || next_ >= n_items_) return false;
    slot = slots_.take(next_++);
    return true;
  }
  bool in_turn(std::size_t step, std::size_t item) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return failed_ || !steps_[step].in_order || passed_[step] == item; });
    return !failed_;
  }
  template <class Change>
  void change(Change&& make) {
    {
      const std::lock_guard lock(mutex_);
      make();
    }
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t n_items_;
  std::size_t next_ = 0;
  bool failed_ = false;
  std::span<const Step> steps_;
  std::vector<std::size_t> passed_;  // items through each step in order
  Slots slots_;
};

void on_many_threads(std::size_t n_items, std::size_t n_slots, std::span<const Step> steps) {
  Carriers carriers(n_items, n_slots, steps);
  on_threads(static_cast<int>(std::min<std::size_t>(thread_count(), n_slots)),
             [&] { carriers.carry(); });
}

}  // namespace

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

void alone(const std::function<void()>& work) { tbb::task_arena(1).execute(work); }

namespace {

/// Runs `work`, which starts threads. oneTBB throws a plain runtime_error where the system has no
/// memory for one; it leaves as std::jthread's would.
template <class Work>
void starting_threads(Work&& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    if (!std::string_view(error.what()).starts_with("pthread_create")) throw;
    throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
  }
}

}  // namespace

void for_ranges(std::size_t n, std::size_t grain,
                const std::function<void(std::size_t, std::size_t)>& body) {
  if (n == 0) return;
  if (n <= grain) {
    body(0, n);
    return;
  }
  starting_threads([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, grain),
                      [&](const tbb::blocked_range<std::size_t>& r) { body(r.begin(), r.end()); });
  });
}

namespace {

/// A token is a slot.
void on_many_threads(std::size_t n_items, std::size_t n_slots, std::span<const Step> steps) {
  Slots slots(n_slots);
  std::size_t next = 0;
  auto chain = tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                                   [&](tbb::flow_control& control) -> std::size_t {
                                                     if (next >= n_items) {
                                                       control.stop();
                                                       return 0;
                                                     }
                                                     return slots.take(next++);
                                                   });
  for (const Step& step : steps) {
    chain =
        chain & tbb::make_filter<std::size_t, std::size_t>(
                    step.in_order ? tbb::filter_mode::serial_in_order : tbb::filter_mode::parallel,
                    [&](std::size_t slot) {
                      step.run(slots.item(slot), slot);
                      return slot;
                    });
  }
  const auto end = tbb::make_filter<std::size_t, void>(
      tbb::filter_mode::parallel, [&](std::size_t slot) { slots.give_back(slot); });
  starting_threads([&] { tbb::parallel_pipeline(n_slots, chain & end); });
}

}  // namespace

#endif

std::size_t pipeline_slots() {
  const auto n_threads = static_cast<std::size_t>(thread_count());
  return n_threads == 1 ? 1 : 2 * n_threads;
}

void pipeline(std::size_t n_items, std::size_t n_slots, std::span<const Step> steps) {
  if (n_items > 1 && n_slots > 1 && thread_count() > 1) {
    on_many_threads(n_items, n_slots, steps);
    return;
  }
  for (std::size_t item = 0; item < n_items; ++item) {
    for (const Step& step : steps) step.run(item, 0);
  }
}

}  // namespace mc::base
