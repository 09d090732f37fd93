// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <vector>

#include "mc/base.hpp"

// The planes between slabs: both slabs need their bits, and whichever thread comes first leaves
// them for the other. A plane that is gone is only classified again.

namespace mc::extraction {

class SharedPlanes {
 public:
  /// Keeps at most `n_planes` from now on, none of them yet: as many as slabs can be at work.
  void reset(std::size_t n_planes) {
    slots_ = std::vector<Slot>(n_planes);
    turn_ = 0;
  }

  /// Forgets everything, but keeps the memory.
  void forget() {
    for (Slot& slot : slots_) slot.plane = kNone;
  }

  /// Copies the bits of a plane, if they are here, and forgets them: nobody else will ask.
  bool take(std::int32_t plane, Buffer<std::uint64_t>& words) {
    const std::lock_guard lock(mutex_);
    const auto slot = std::ranges::find(slots_, plane, &Slot::plane);
    if (slot == slots_.end()) return false;
    std::copy(slot->words.begin(), slot->words.end(), words.begin());
    slot->plane = kNone;
    return true;
  }

  /// Leaves the bits of a plane for the next to ask.
  void offer(std::int32_t plane, const Buffer<std::uint64_t>& words) {
    const std::lock_guard lock(mutex_);
    Slot& slot = slots_[turn_++ % slots_.size()];
    slot.words.assign(words.begin(), words.end());
    slot.plane = plane;
  }

 private:
  static constexpr std::int32_t kNone = -1;
  struct Slot {
    std::int32_t plane = kNone;
    Buffer<std::uint64_t> words;
  };

  std::mutex mutex_;
  std::vector<Slot> slots_;
  std::size_t turn_ = 0;
};

}  // namespace mc::extraction
