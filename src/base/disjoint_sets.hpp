// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cassert>

// Disjoint sets of numbers, each named by its least member: parent[n] <= n, and equal for a set's
// name. Path halving: Tarjan and van Leeuwen, "Worst-case analysis of set union algorithms", JACM
// 1984. Parents may be any container of numbers.

namespace mc::base {

/// The name of the set that holds `n`.
template <class Parents, class Id>
Id find_set(Parents& parent, Id n) {
  while (parent[n] != n) {
    assert(parent[n] < n);
    parent[n] = parent[parent[n]];
    n = static_cast<Id>(parent[n]);
  }
  return n;
}

/// Makes the sets that hold `a` and `b` one. Returns whether they were two.
template <class Parents, class Id>
bool unite_sets(Parents& parent, Id a, Id b) {
  a = find_set(parent, a);
  b = find_set(parent, b);
  parent[std::max(a, b)] = std::min(a, b);
  return a != b;
}

}  // namespace mc::base
