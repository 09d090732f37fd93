// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

// The most memory that the process holds while this lives.

namespace mc::cli {

/// Looks every two milliseconds: what the kernel keeps as a peak counts the pages of mapped files,
/// which are a cache.
class PeakMemory {
 public:
  PeakMemory();
  /// Bytes, pages of files aside.
  [[nodiscard]] std::uint64_t bytes();

 private:
  void look();

  std::atomic<std::uint64_t> most_{0};
  std::jthread thread_;  // last: it uses the others
};

}  // namespace mc::cli
