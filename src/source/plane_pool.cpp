// SPDX-License-Identifier: MIT
#include "source/plane_pool.hpp"

namespace mc::source {

void PlanePool::reserve(std::size_t n) {
  const std::lock_guard lock(mutex_);
  free_.reserve(n);
  while (all_.size() < n) {
    all_.emplace_back().resize(plane_bytes_);
    free_.push_back(&all_.back());
  }
}

std::shared_ptr<std::byte> PlanePool::take() {
  Buffer<std::byte>* plane = any_free();
  plane->resize(plane_bytes_);
  return {plane->data(), [pool = shared_from_this(), plane](const std::byte* /*data*/) {
            const std::lock_guard lock(pool->mutex_);
            pool->free_.push_back(plane);
          }};
}

Buffer<std::byte>* PlanePool::any_free() {
  const std::lock_guard lock(mutex_);
  if (free_.empty()) return &all_.emplace_back();
  Buffer<std::byte>* plane = free_.back();
  free_.pop_back();
  return plane;
}

}  // namespace mc::source
