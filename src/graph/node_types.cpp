// SPDX-License-Identifier: MIT
#include "graph/node_types.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>

#include "graph/nodes/arithmetic.hpp"
#include "graph/nodes/combinations.hpp"
#include "graph/nodes/control.hpp"
#include "graph/nodes/data.hpp"
#include "graph/nodes/generators.hpp"
#include "graph/nodes/solids.hpp"
#include "graph/nodes/transforms.hpp"

// Puts the rows of all sections into one table and holds it against NodeType.

namespace mc::graph {

namespace {

template <std::size_t... kN>
constexpr auto joined_rows(const NodeRow (&... sections)[kN]) {
  std::array<const NodeRow*, (kN + ...)> rows{};
  std::size_t n = 0;
  const auto take = [&](const auto& section) {
    for (const NodeRow& row : section) rows[n++] = &row;
  };
  (take(sections), ...);
  return rows;
}

constexpr auto kRows =
    joined_rows(kArithmetic, kControl, kGenerators, kTransforms, kSolids, kCombinations, kData);

/// Whether each type from the first on has a row, in the order of NodeType, and all rows of one
/// type become operations in the same way.
constexpr bool follow_node_type() {
  std::size_t next = 0;
  for (std::size_t n = 0; n < kRows.size(); ++n) {
    const bool goes_on = n > 0 && kRows[n]->type == kRows[n - 1]->type;
    if (goes_on ? kRows[n]->emit != kRows[n - 1]->emit : kRows[n]->type != NodeType(next++)) {
      return false;
    }
  }
  return true;
}
static_assert(follow_node_type(), "the rows of node types are not in the order of NodeType");

/// Compilers spell a value that no enumerator has as a number in a cast.
template <NodeType kType>
constexpr bool is_enumerator() {
  constexpr std::string_view kText = __PRETTY_FUNCTION__;
  return kText[kText.find("kType = ") + 8] != '(';
}
constexpr auto kLast = static_cast<std::size_t>(kRows.back()->type);
static_assert(is_enumerator<NodeType(kLast)>() && !is_enumerator<NodeType(kLast + 1)>(),
              "an enumerator of NodeType has no row");

}  // namespace

std::span<const NodeRow* const> node_rows() { return kRows; }

const NodeRow& row_of(NodeType type) {
  const auto found =
      std::lower_bound(kRows.begin(), kRows.end(), type,
                       [](const NodeRow* row, NodeType wanted) { return row->type < wanted; });
  assert(found != kRows.end() && (*found)->type == type);
  return **found;
}

const NodeRow* find_row(std::string_view name) {
  const auto found = std::find_if(kRows.begin(), kRows.end(),
                                  [&](const NodeRow* row) { return row->name == name; });
  return found == kRows.end() ? nullptr : *found;
}

std::size_t GivenKeys::place_of(std::string_view name) const {
  const auto found = std::find_if(keys_.begin(), keys_.end(),
                                  [&](const NodeKey& key) { return key.name == name; });
  assert(found != keys_.end());
  return static_cast<std::size_t>(found - keys_.begin());
}

}  // namespace mc::graph
