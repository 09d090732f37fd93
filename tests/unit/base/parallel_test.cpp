// SPDX-License-Identifier: MIT
#include "base/parallel.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace mc::base {
namespace {

/// Five steps over n items: what they saw of order and of their slots.
struct Seen {
  std::vector<std::size_t> numbered, placed;
  std::vector<std::atomic<int>> in_slot;
  std::vector<std::size_t> item_of;
  std::atomic<int> n_written{0}, n_alive{0}, most_alive{0};
  std::atomic<bool> shared_slot{false}, wrong_item{false};

  explicit Seen(std::size_t n_slots) : in_slot(n_slots), item_of(n_slots) {}

  void run(std::size_t n, std::size_t n_slots) {
    const std::array<Step, 5> steps{
        {{false, [this](std::size_t item, std::size_t slot) { make(item, slot); }},
         {true, [this](std::size_t item, std::size_t) { numbered.push_back(item); }},
         {false,
          [this](std::size_t item, std::size_t slot) {
            if (item_of[slot] != item) wrong_item = true;
          }},
         {true, [this](std::size_t item, std::size_t) { placed.push_back(item); }},
         {false, [this](std::size_t, std::size_t slot) {
            --in_slot[slot];
            --n_alive;
            ++n_written;
          }}}};
    pipeline(n, n_slots, steps);
  }
  void make(std::size_t item, std::size_t slot) {
    if (in_slot[slot].fetch_add(1) != 0) shared_slot = true;
    item_of[slot] = item;
    const int alive = ++n_alive;
    for (int most = most_alive; alive > most && !most_alive.compare_exchange_weak(most, alive);) {
    }
    if (item % 7 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
};

TEST(Pipeline, KeepsOrderAndSlots) {
  for (const int threads : {1, 2, 3, 7}) {
    for (const std::size_t n_slots : {1U, 2U, 6U}) {
      SCOPED_TRACE(std::to_string(threads) + " threads, " + std::to_string(n_slots) + " slots");
      const ThreadLimit limit(threads);
      Seen seen(n_slots);
      seen.run(100, n_slots);
      std::vector<std::size_t> in_order(100);
      for (std::size_t i = 0; i < in_order.size(); ++i) in_order[i] = i;
      EXPECT_EQ(seen.numbered, in_order);
      EXPECT_EQ(seen.placed, in_order);
      EXPECT_EQ(seen.n_written, 100);
      EXPECT_FALSE(seen.shared_slot);
      EXPECT_FALSE(seen.wrong_item);
      EXPECT_LE(seen.most_alive, static_cast<int>(n_slots));
    }
  }
}

TEST(Pipeline, AFaultOfAnyStepEndsIt) {
  for (const int threads : {1, 4}) {
    for (std::size_t faulty = 0; faulty < 5; ++faulty) {
      SCOPED_TRACE(std::to_string(threads) + " threads, step " + std::to_string(faulty));
      const ThreadLimit limit(threads);
      std::atomic<int> running{0};
      std::atomic<int> passed{0};
      std::array<Step, 5> steps;
      for (std::size_t s = 0; s < steps.size(); ++s) {
        steps[s].in_order = s % 2 == 1;
        steps[s].run = [&, s](std::size_t item, std::size_t) {
          ++running;
          const bool fails = s == faulty && item == 20;
          passed += s == 4 ? 1 : 0;
          --running;
          if (fails) throw std::runtime_error("step " + std::to_string(s));
        };
      }
      try {
        pipeline(1000, 8, steps);
        ADD_FAILURE() << "nothing was thrown";
      } catch (const std::runtime_error& e) {
        EXPECT_EQ(e.what(), "step " + std::to_string(faulty));
      }
      EXPECT_EQ(running, 0);
      EXPECT_LT(passed, 1000);
    }
  }
}

TEST(Pipeline, NoItemsAreNoWork) {
  const std::array<Step, 1> steps{{{true, [](std::size_t, std::size_t) { ADD_FAILURE(); }}}};
  pipeline(0, 4, steps);
}

}  // namespace
}  // namespace mc::base
