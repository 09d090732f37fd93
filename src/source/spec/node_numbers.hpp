// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "mc/graph.hpp"

// Numbers of a document, which are double, into a node, where they are float.

namespace mc::source {

inline void put(Node& node, std::size_t at, double value) {
  node.numbers[at] = static_cast<float>(value);
}

inline void put3(Node& node, std::size_t at, const Vec3& value) {
  for (std::size_t n = 0; n < 3; ++n) {
    put(node, at + n, value[n]);
  }
}

}  // namespace mc::source
