// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "graph/node_types.hpp"
#include "mc/graph.hpp"
#include "source/json/object_reader.hpp"
#include "source/spec/spec_files.hpp"

// From the JSON of nodes to a Graph: names, types, their keys, cycles.

namespace mc::source {

class NodeLoader {
 public:
  /// `named` is the document's "nodes", null where it has none. `files` reads what nodes name.
  NodeLoader(const JsonDocument& document, const JsonValue* named, const GraphSettings& settings,
             SpecFiles& files);

  /// Loads a node; where it has faults, a harmless one.
  NodeId load(const JsonValue& value);
  /// Loads the named nodes that nothing refers to, so that their faults are seen too.
  void load_unused();

  [[nodiscard]] const Graph& graph() const { return graph_; }

 private:
  enum class State : std::uint8_t { unseen, open, done };
  struct Named {
    const JsonValue* value = nullptr;
    State state = State::unseen;
    NodeId id{};
  };

  void take_names(const JsonValue& named);
  NodeId load_name(const JsonValue& reference);
  NodeId load_object(const JsonValue& value);
  NodeId resolve(const std::string& name, const JsonValue& reference);
  /// Reads the row's keys, and what they name, into the node.
  void fill(Node& node, ObjectReader& keys, const graph::NodeRow& row);
  void read_key(Node& node, ObjectReader& keys, const graph::NodeKey& key, graph::GivenKeys& given);
  /// Reads pairs, lists and files, once the keys are known to go together.
  void read_contents(Node& node, ObjectReader& keys, const graph::NodeKeys& row);
  void take_input(Node& node, ObjectReader& keys, const char* key);
  void take_inputs(Node& node, ObjectReader& keys);
  NodeId add(Node node, const JsonValue& at);
  /// A fault that is worth saying once only: limits that many nodes would break.
  NodeId break_limit(const JsonValue& at, const std::string& message);

  const JsonDocument& document_;
  SpecFiles& files_;
  Graph graph_;
  NodeId harmless_{};
  std::map<std::string, Named, std::less<>> named_;
  std::vector<std::string> names_;  // in the order of the text, for suggestions
  std::vector<std::string> open_;   // names that are being loaded, outermost first
  std::uint32_t level_ = 0;
  bool limit_broken_ = false;
};

}  // namespace mc::source
