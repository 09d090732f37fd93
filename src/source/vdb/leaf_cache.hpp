// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "mc/base.hpp"

namespace mc::source {

/// Leaves that were unpacked last, for those who ask for them again: neighbours of blocks, some of
/// which lie a layer of leaves on. Each leaf has one place, so leaves that follow each other do not
/// push each other out. May be asked by several threads at once.
class LeafCache {
 public:
  LeafCache(std::size_t n_leaves, std::size_t leaf_bytes);

  /// Copies a leaf's samples, if they are there.
  bool find(std::size_t leaf, std::byte* to);
  void keep(std::size_t leaf, const std::byte* samples);

  [[nodiscard]] std::uint64_t held_bytes() const;

 private:
  [[nodiscard]] std::size_t place_of(std::size_t leaf) const { return leaf % held_.size(); }
  [[nodiscard]] std::mutex& mutex_of(std::size_t place) { return mutexes_[place % kMutexes]; }

  static constexpr std::size_t kMutexes = 64;

  std::size_t leaf_bytes_;
  std::vector<std::size_t> held_;  ///< of each place: its leaf and one, or 0
  Buffer<std::byte> samples_;
  std::array<std::mutex, kMutexes> mutexes_;
};

}  // namespace mc::source
