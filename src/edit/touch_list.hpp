// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edit/brush.hpp"

namespace mc::edit {

/// The blocks that positions of a stroke may reach, by (z, y, x), each with its positions in order.
class TouchList {
 public:
  /// `groups`: [first, last) of the stroke's. Stops counting past `most_blocks` a position.
  /// Errors   limit: a position, or the list itself, is larger than that.
  TouchList(const Stroke& stroke, std::uint32_t first, std::uint32_t last,
            std::uint64_t most_blocks);

  [[nodiscard]] std::size_t size() const { return blocks_.size(); }
  [[nodiscard]] const Index3& block(std::size_t n) const { return blocks_[n]; }
  [[nodiscard]] std::span<const std::uint32_t> positions(std::size_t n) const {
    return std::span(positions_).subspan(starts_[n], starts_[n + 1] - starts_[n]);
  }

 private:
  std::vector<Index3> blocks_;
  std::vector<std::size_t> starts_;
  std::vector<std::uint32_t> positions_;
};

/// Calls f(group's positions) for each run of positions of one group.
template <class F>
void for_groups_of(const Stroke& stroke, std::span<const std::uint32_t> positions, F&& f) {
  for (std::size_t first = 0; first < positions.size();) {
    std::size_t last = first + 1;
    const std::uint32_t group = stroke.positions[positions[first]].group;
    while (last < positions.size() && stroke.positions[positions[last]].group == group) ++last;
    f(positions.subspan(first, last - first));
    first = last;
  }
}

}  // namespace mc::edit
