// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mc/base.hpp"

// Finds equal positions: an open-addressed table of vertex ids, eight bytes a slot.

namespace mc::mesh {

/// Knows positions by their exact bits (-0 counts as 0, so a NaN equals itself and cannot make the
/// table slow). The hash is seeded anew for each table, so that no file can choose its collisions;
/// answers do not depend on the seed.
class PositionIndex {
 public:
  PositionIndex();

  /// The id under which the position of `positions[id]` is known; it becomes known as `id` if it
  /// was not. Ids up to 2^40. `positions` holds all that was asked about before. T is float or
  /// double.
  template <class T>
  std::uint64_t first(std::span<const std::array<T, 3>> positions, std::uint64_t id);

 private:
  template <class T>
  [[nodiscard]] std::uint64_t hash(const std::array<T, 3>& p) const;
  template <class T>
  void grow(std::span<const std::array<T, 3>> positions);

  std::uint64_t seed_;
  std::uint64_t n_known_ = 0;
  std::vector<std::uint64_t> slots_;  // 24 bits of hash above 40 bits of id + 1; 0 is free
};

}  // namespace mc::mesh
