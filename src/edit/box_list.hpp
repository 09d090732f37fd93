// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "edit/block.hpp"

namespace mc::edit {

/// Adds a box to a list that stays short: past kMostBoxes, neighbours in time are joined.
inline void add_box(const IndexBox& box, std::vector<IndexBox>& list) {
  constexpr std::size_t kMostBoxes = 4096;
  if (is_empty(box)) return;
  if (list.size() >= kMostBoxes) {
    for (std::size_t n = 0; n < list.size() / 2; ++n) {
      list[n] = joined(list[2 * n], list[2 * n + 1]);
    }
    list.resize(list.size() / 2);
  }
  list.push_back(box);
}

}  // namespace mc::edit
