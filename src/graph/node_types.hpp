// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

#include "graph/node_keys.hpp"
#include "graph/program.hpp"

// The table of node types. A row is all that is known of one: its name and keys in an mc-volume
// document, and how it becomes operations, each of which has a row in ops.def. The rows are in
// nodes/, by the sections of mc-volume(5). A new node type is an enumerator at the end of
// NodeType, a row, an entry in the manual page and a test. `MC_TEST_WRITE=1 mc_tests
// --gtest_filter=NodeTable.*` then writes the schema and the page's list of keys from the row,
// scripts/node_pictures.py the picture; without the variable the tests compare them with the row.

namespace mc::graph {

class Emitter;
struct Domain;

struct NodeRow {
  NodeType type;
  const char* name;  ///< in documents; several names may make nodes of one type
  NodeKeys keys;
  /// Emits operations for the node's value in a domain.
  Value (*emit)(Emitter& to, const Node& node, const Domain& domain);
  /// What a document's node needs besides its keys one by one: numbers that several keys make, and
  /// faults of keys against each other.
  void (*make)(Node& node, GivenKeys& given) = nullptr;
  /// Whether Node::list is as the type needs it; null: there is none.
  bool (*takes_list)(std::span<const float> list) = nullptr;
  /// Throws Error(usage) if the samples that the node reads are wrong.
  void (*check_samples)(const Node& node) = nullptr;
};

/// All rows, in the order of NodeType.
[[nodiscard]] std::span<const NodeRow* const> node_rows();

/// A row of the type.
[[nodiscard]] const NodeRow& row_of(NodeType type);

/// The row of that name; null if there is none.
[[nodiscard]] const NodeRow* find_row(std::string_view name);

}  // namespace mc::graph
