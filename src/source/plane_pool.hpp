// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

#include "mc/base.hpp"

namespace mc::source {

/// Memory of planes of one size; what nothing points to any more is used again.
/// Threads  all calls, from any thread.
class PlanePool : public std::enable_shared_from_this<PlanePool> {
 public:
  explicit PlanePool(std::size_t plane_bytes) : plane_bytes_(plane_bytes) {}

  /// Takes memory for `n` planes that are there at once.
  void reserve(std::size_t n);
  /// A plane of undefined contents. It keeps the pool alive.
  [[nodiscard]] std::shared_ptr<std::byte> take();

 private:
  Buffer<std::byte>* any_free();

  std::size_t plane_bytes_;
  std::mutex mutex_;
  std::deque<Buffer<std::byte>> all_;
  std::vector<Buffer<std::byte>*> free_;
};

}  // namespace mc::source
