// SPDX-License-Identifier: MIT
#include "process/simplify/collapse_queue.hpp"

#include <algorithm>
#include <bit>

namespace mc::process {

/// The exponent and four bits of the fraction.
std::uint32_t CollapseQueue::bucket_of(float cost) {
  constexpr std::uint32_t kShift = 23 - 4;
  constexpr std::uint32_t kLeast = (127U - 40U) << 4U;
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(cost) >> kShift;
  return std::clamp(bits, kLeast, kLeast + kBuckets - 1) - kLeast;
}

void CollapseQueue::put(std::uint32_t vertex, float cost) {
  remove(vertex);
  const std::uint32_t bucket = bucket_of(cost);
  Link& ends = ends_[bucket];
  links_[vertex] = {ends.after, kNone};
  (ends.after == kNone ? ends.before : links_[ends.after].after) = vertex;
  ends.after = vertex;
  buckets_of_[vertex] = static_cast<std::uint16_t>(bucket);
  filled_[bucket / 64] |= std::uint64_t{1} << (bucket % 64);
}

void CollapseQueue::remove(std::uint32_t vertex) {
  const std::uint16_t bucket = buckets_of_[vertex];
  if (bucket == kNoBucket) return;
  Link& ends = ends_[bucket];
  const auto [before, after] = links_[vertex];
  (before == kNone ? ends.before : links_[before].after) = after;
  (after == kNone ? ends.after : links_[after].before) = before;
  buckets_of_[vertex] = kNoBucket;
  if (ends.before == kNone) filled_[bucket / 64] &= ~(std::uint64_t{1} << (bucket % 64));
}

std::uint32_t CollapseQueue::take() {
  const auto word = std::ranges::find_if(filled_, [](std::uint64_t w) { return w != 0; });
  if (word == filled_.end()) return kNone;
  const std::size_t bucket = static_cast<std::size_t>(word - filled_.begin()) * 64 +
                             static_cast<std::size_t>(std::countr_zero(*word));
  const std::uint32_t vertex = ends_[bucket].before;
  remove(vertex);
  return vertex;
}

}  // namespace mc::process
