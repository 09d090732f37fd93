// SPDX-License-Identifier: MIT
#include "source/vdb/leaf_cache.hpp"

#include <algorithm>
#include <cstring>

namespace mc::source {

LeafCache::LeafCache(std::size_t n_leaves, std::size_t leaf_bytes)
    : leaf_bytes_(leaf_bytes),
      held_(std::max<std::size_t>(n_leaves, 1)),
      samples_(held_.size() * leaf_bytes) {}

bool LeafCache::find(std::size_t leaf, std::byte* to) {
  const std::size_t place = place_of(leaf);
  const std::lock_guard lock(mutex_of(place));
  if (held_[place] != leaf + 1) return false;
  std::memcpy(to, samples_.data() + place * leaf_bytes_, leaf_bytes_);
  return true;
}

void LeafCache::keep(std::size_t leaf, const std::byte* samples) {
  const std::size_t place = place_of(leaf);
  const std::lock_guard lock(mutex_of(place));
  std::memcpy(samples_.data() + place * leaf_bytes_, samples, leaf_bytes_);
  held_[place] = leaf + 1;
}

std::uint64_t LeafCache::held_bytes() const {
  return held_.size() * (leaf_bytes_ + sizeof(held_[0]));
}

}  // namespace mc::source
