// SPDX-License-Identifier: MIT
#include "source/spec/nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

// Names are loaded where they are first referred to; a name that is still open when it is met again
// closes a ring.

namespace mc::source {

namespace {

/// Names of all types, sorted.
std::vector<std::string> type_names() {
  std::vector<std::string> names;
  for (const graph::NodeRow* row : graph::node_rows()) names.emplace_back(row->name);
  std::ranges::sort(names);
  return names;
}

bool is_coordinate(std::string_view name) { return name == "x" || name == "y" || name == "z"; }

}  // namespace

NodeLoader::NodeLoader(const JsonDocument& document, const JsonValue* named,
                       const GraphSettings& settings, SpecFiles& files)
    : document_(document), files_(files), graph_(settings) {
  harmless_ = graph_.add({});
  if (named != nullptr) {
    take_names(*named);
  }
  for (const char* coordinate : {"x", "y", "z"}) {
    names_.emplace_back(coordinate);
  }
}

void NodeLoader::take_names(const JsonValue& named) {
  if (named.kind != JsonKind::object) {
    document_.fault(named, as_found(named) + ": expected an object of named nodes");
    return;
  }
  for (const JsonMember& member : named.members) {
    if (is_ignored_key(member.key)) {
      continue;
    }
    if (is_coordinate(member.key)) {
      document_.fault(member.value, "names a node like the coordinate " + in_quotes(member.key) +
                                        ": expected another name");
      continue;
    }
    named_.emplace(member.key, Named{&member.value, State::unseen, {}});
    names_.push_back(member.key);
  }
}

NodeId NodeLoader::break_limit(const JsonValue& at, const std::string& message) {
  if (!std::exchange(limit_broken_, true)) {
    document_.fault(at, message);
  }
  return harmless_;
}

NodeId NodeLoader::add(Node node, const JsonValue& at) {
  if (!std::all_of(node.list.begin(), node.list.end(), [](float v) { return std::isfinite(v); })) {
    document_.fault(at, "works out to numbers past +-3.4e38 (float32): expected smaller ones");
    return harmless_;
  }
  if (graph_.size() >= Graph::kMaxNodes || node.inputs.size() > Graph::kMaxNodes) {
    return break_limit(at, "is one node more than the " + std::to_string(Graph::kMaxNodes) +
                               " that a document may hold");
  }
  for (const NodeId input : node.inputs) {
    if (graph_.depth(input) >= Graph::kMaxDepth) {
      return break_limit(
          at, "nodes nest deeper than " + std::to_string(Graph::kMaxDepth) + " levels here");
    }
  }
  return graph_.add(std::move(node));
}

NodeId NodeLoader::load(const JsonValue& value) {
  if (level_ >= Graph::kMaxDepth) {
    return break_limit(
        value, "nodes nest deeper than " + std::to_string(Graph::kMaxDepth) + " levels here");
  }
  ++level_;
  NodeId id = harmless_;
  if (value.kind == JsonKind::number) {
    Node node;
    if (std::abs(value.number) > kAnyFloat.hi) {
      document_.fault(value, as_found(value) + ": expected " + kAnyFloat.text);
    } else {
      node.numbers[0] = static_cast<float>(value.number);
    }
    id = add(std::move(node), value);
  } else if (value.kind == JsonKind::string) {
    id = load_name(value);
  } else if (value.kind == JsonKind::object) {
    id = load_object(value);
  } else {
    document_.fault(
        value, as_found(value) + ": expected a node: a number, a name, or an object with \"type\"");
  }
  --level_;
  return id;
}

NodeId NodeLoader::load_name(const JsonValue& reference) {
  if (is_coordinate(reference.text)) {
    Node node;
    node.type = graph::find_row(reference.text)->type;
    return add(std::move(node), reference);
  }
  if (named_.contains(reference.text)) {
    return resolve(reference.text, reference);
  }
  if (document_.faults.full()) {
    document_.faults.skip();
  } else {
    document_.fault(reference, "there is no node " + in_quotes(reference.text) + "; " +
                                   suggestion(reference.text, names_));
  }
  return harmless_;
}

NodeId NodeLoader::resolve(const std::string& name, const JsonValue& reference) {
  Named& named = named_.find(name)->second;
  if (named.state == State::open) {
    std::string ring;
    for (auto at = std::find(open_.begin(), open_.end(), name); at != open_.end(); ++at) {
      ring += *at + " -> ";
    }
    document_.fault(reference, "closes a ring of nodes: " + ring + name +
                                   ": expected nodes that do not need themselves");
    return harmless_;
  }
  if (named.state == State::unseen) {
    named.state = State::open;
    open_.push_back(name);
    named.id = load(*named.value);
    open_.pop_back();
    named.state = State::done;
  }
  return named.id;
}

void NodeLoader::load_unused() {
  for (auto& [name, named] : named_) {
    if (named.state == State::unseen) {
      resolve(name, *named.value);
    }
  }
}

NodeId NodeLoader::load_object(const JsonValue& value) {
  ObjectReader keys(document_, value, "a node");
  const JsonValue* type = keys.required("type");
  if (type == nullptr) {
    return harmless_;
  }
  const graph::NodeRow* row =
      type->kind == JsonKind::string ? graph::find_row(type->text) : nullptr;
  if (row == nullptr) {
    document_.fault(*type, type->kind == JsonKind::string
                               ? "there is no node type " + in_quotes(type->text) + "; " +
                                     suggestion(type->text, type_names())
                               : as_found(*type) + ": expected the name of a node type");
    return harmless_;
  }
  const std::string what = "a node of type " + in_quotes(type->text);
  ObjectReader own(document_, value, what.c_str());
  own.optional("type");
  Node node;
  node.type = row->type;
  fill(node, own, *row);
  own.finish();
  return document_.faults.empty() ? add(std::move(node), value) : harmless_;
}

}  // namespace mc::source
