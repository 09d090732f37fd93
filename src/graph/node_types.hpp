// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string_view>

#include "graph/node_keys.hpp"
#include "graph/program.hpp"

// The table of node types. A row is all that is known of one: its name and keys in an mc-volume
// document, and how it becomes operations, each of which has a row in ops.def. The rows are in
// nodes/, a file for each section of mc-volume(5). A new node type is an enumerator of NodeType and
// a row; its entry in the manual page and the schema are held against the row by tests.

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
  /// Throws Error(usage) where the samples that the node reads are wrong.
  void (*check_samples)(const Node& node) = nullptr;
};

/// All rows, in the order of NodeType.
[[nodiscard]] std::span<const NodeRow* const> node_rows();

/// A row of the type.
[[nodiscard]] const NodeRow& row_of(NodeType type);

/// The row of that name; null where there is none.
[[nodiscard]] const NodeRow* find_row(std::string_view name);

}  // namespace mc::graph
