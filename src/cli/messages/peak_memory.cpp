// SPDX-License-Identifier: MIT
#include "cli/messages/peak_memory.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "base/machine_memory.hpp"

namespace mc::cli {

namespace {
constexpr std::chrono::milliseconds kEvery{2};
}  // namespace

PeakMemory::PeakMemory()
    : thread_([this](const std::stop_token& stop) {
        std::mutex mutex;
        std::condition_variable_any ended;
        std::unique_lock lock(mutex);
        while (!stop.stop_requested()) {
          look();
          ended.wait_for(lock, stop, kEvery, [] { return false; });
        }
      }) {}

void PeakMemory::look() {
  const std::uint64_t now = base::resident_bytes();
  std::uint64_t most = most_;
  while (now > most && !most_.compare_exchange_weak(most, now)) {
  }
}

std::uint64_t PeakMemory::bytes() {
  look();
  return most_;
}

}  // namespace mc::cli
