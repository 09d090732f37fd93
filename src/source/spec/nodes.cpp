// SPDX-License-Identifier: MIT
#include "source/spec/nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "source/spec/node_numbers.hpp"

// One small function for each family of node types reads its keys. Names are loaded where they are
// first referred to; a name that is still open when it is met again closes a ring.

namespace mc::source {

namespace {

const std::map<std::string, NodeType, std::less<>>& node_types() {
  static const std::map<std::string, NodeType, std::less<>> kTypes{
      {"constant", NodeType::constant},
      {"add", NodeType::add},
      {"mul", NodeType::mul},
      {"min", NodeType::min},
      {"max", NodeType::max},
      {"sub", NodeType::sub},
      {"div", NodeType::div},
      {"pow", NodeType::pow},
      {"mod", NodeType::mod},
      {"abs", NodeType::abs},
      {"neg", NodeType::neg},
      {"sqrt", NodeType::sqrt},
      {"floor", NodeType::floor},
      {"fract", NodeType::fract},
      {"sin", NodeType::sin},
      {"clamp", NodeType::clamp},
      {"remap", NodeType::remap},
      {"smoothstep", NodeType::smoothstep},
      {"mix", NodeType::mix},
      {"select", NodeType::select},
      {"curve", NodeType::curve},
      {"terrace", NodeType::terrace},
      {"floor-hard", NodeType::floor_hard},
      {"white", NodeType::white},
      {"value", NodeType::value},
      {"value-cubic", NodeType::value_cubic},
      {"perlin", NodeType::perlin},
      {"simplex", NodeType::simplex},
      {"opensimplex2", NodeType::opensimplex2},
      {"cellular", NodeType::cellular},
      {"unity-perlin2d", NodeType::unity_perlin2d},
      {"fbm", NodeType::fbm},
      {"ridged", NodeType::ridged},
      {"billow", NodeType::billow},
      {"pingpong", NodeType::pingpong},
      {"warp", NodeType::warp},
      {"translate", NodeType::affine},
      {"rotate", NodeType::affine},
      {"scale", NodeType::affine},
      {"affine", NodeType::affine},
      {"mirror", NodeType::mirror},
      {"repeat", NodeType::repeat},
      {"sphere", NodeType::sphere},
      {"box", NodeType::box},
      {"plane", NodeType::plane},
      {"torus", NodeType::torus},
      {"roundbox", NodeType::roundbox},
      {"capsule", NodeType::capsule},
      {"cylinder", NodeType::cylinder},
      {"cone", NodeType::cone},
      {"ellipsoid", NodeType::ellipsoid},
      {"gyroid", NodeType::gyroid},
      {"union", NodeType::unite},
      {"intersection", NodeType::intersect},
      {"difference", NodeType::difference},
      {"complement", NodeType::complement},
      {"offset", NodeType::offset},
      {"shell", NodeType::shell},
      {"heightmap", NodeType::heightmap},
      {"volume", NodeType::volume},
      {"x", NodeType::x},
      {"y", NodeType::y},
      {"z", NodeType::z},
  };
  return kTypes;
}

bool is_coordinate(std::string_view name) { return name == "x" || name == "y" || name == "z"; }

NodeType coordinate_type(std::string_view name) {
  return name == "x" ? NodeType::x : name == "y" ? NodeType::y : NodeType::z;
}

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
      put(node, 0, value.number);
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
    node.type = coordinate_type(reference.text);
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
  const auto found =
      type->kind == JsonKind::string ? node_types().find(type->text) : node_types().end();
  if (found == node_types().end()) {
    std::vector<std::string> names;
    for (const auto& [name, unused] : node_types()) {
      names.push_back(name);
    }
    document_.fault(*type, type->kind == JsonKind::string
                               ? "there is no node type " + in_quotes(type->text) + "; " +
                                     suggestion(type->text, names)
                               : as_found(*type) + ": expected the name of a node type");
    return harmless_;
  }
  const std::string what = "a node of type " + in_quotes(type->text);
  ObjectReader own(document_, value, what.c_str());
  own.optional("type");
  Node node;
  node.type = found->second;
  fill(node, own, type->text);
  own.finish();
  return document_.faults.empty() ? add(std::move(node), value) : harmless_;
}

void NodeLoader::take_input(Node& node, ObjectReader& keys, const char* key) {
  const JsonValue* found = keys.required(key);
  node.inputs.push_back(found == nullptr ? harmless_ : load(*found));
}

/// Either "inputs", a list, or "a" and "b".
void NodeLoader::take_inputs(Node& node, ObjectReader& keys) {
  const JsonValue* list = keys.optional("inputs");
  const JsonValue* a = keys.optional("a");
  const JsonValue* b = keys.optional("b");
  if ((list == nullptr) == (a == nullptr && b == nullptr) ||
      (list == nullptr && (a == nullptr || b == nullptr))) {
    document_.fault(keys.value(), R"(expected either "inputs" or both "a" and "b")");
    return;
  }
  if (list == nullptr) {
    node.inputs = {load(*a), load(*b)};
    return;
  }
  if (list->kind != JsonKind::array || list->items.empty()) {
    document_.fault(*list, (list->kind == JsonKind::array ? "is an empty array" : as_found(*list)) +
                               ": expected an array of one node or more");
    return;
  }
  for (const JsonValue& item : list->items) {
    node.inputs.push_back(load(item));
  }
}

void NodeLoader::fill(Node& node, ObjectReader& keys, const std::string& name) {
  switch (node.type) {
    case NodeType::x:
    case NodeType::y:
    case NodeType::z:
      return;
    case NodeType::constant:
      return put(node, 0, keys.number("value", std::nullopt, kAnyFloat));
    case NodeType::add:
    case NodeType::mul:
    case NodeType::min:
    case NodeType::max:
      return take_inputs(node, keys);
    case NodeType::unite:
    case NodeType::intersect:
      take_inputs(node, keys);
      return put(node, 0, keys.number("smooth", 0, kFloatNotNegative));
    case NodeType::sub:
    case NodeType::div:
    case NodeType::pow:
    case NodeType::mod:
    case NodeType::difference:
    case NodeType::mix:
      take_input(node, keys, "a");
      take_input(node, keys, "b");
      if (node.type == NodeType::mix) {
        take_input(node, keys, "t");
      } else if (node.type == NodeType::difference) {
        put(node, 0, keys.number("smooth", 0, kFloatNotNegative));
      }
      return;
    case NodeType::white:
    case NodeType::value:
    case NodeType::value_cubic:
    case NodeType::perlin:
    case NodeType::simplex:
    case NodeType::opensimplex2:
    case NodeType::cellular:
      return fill_generator(node, keys);
    case NodeType::unity_perlin2d:
      return fill_unity(node, keys);
    case NodeType::fbm:
    case NodeType::ridged:
    case NodeType::billow:
    case NodeType::pingpong:
      return fill_fractal(node, keys);
    case NodeType::warp:
      return fill_warp(node, keys);
    case NodeType::select:
    case NodeType::curve:
    case NodeType::terrace:
    case NodeType::floor_hard:
      return fill_control(node, keys);
    case NodeType::affine:
    case NodeType::mirror:
    case NodeType::repeat:
      return fill_transform(node, keys, name);
    case NodeType::sphere:
    case NodeType::box:
    case NodeType::plane:
    case NodeType::torus:
    case NodeType::roundbox:
    case NodeType::capsule:
    case NodeType::cylinder:
    case NodeType::cone:
    case NodeType::ellipsoid:
    case NodeType::gyroid:
      return fill_solid(node, keys);
    case NodeType::offset:
    case NodeType::shell:
      return fill_shell(node, keys);
    case NodeType::heightmap:
      return fill_heightmap(node, keys);
    case NodeType::volume:
      return fill_volume(node, keys);
    default:
      take_input(node, keys, "source");
      return fill_shaping(node, keys);
  }
}

void NodeLoader::fill_shaping(Node& node, ObjectReader& keys) {
  const auto need = [&](bool good, const char* key, const char* message) {
    if (const JsonValue* at = keys.value().find(key); !good && at != nullptr) {
      document_.fault(*at, message);
    }
  };
  if (node.type == NodeType::clamp) {
    put(node, 0, keys.number("min", std::nullopt, kAnyFloat));
    put(node, 1, keys.number("max", std::nullopt, kAnyFloat));
    need(node.numbers[0] <= node.numbers[1], "min", "is above \"max\": expected at most that");
  } else if (node.type == NodeType::remap) {
    const auto from = keys.numbers<2>("from", std::nullopt, kAnyFloat);
    const auto to = keys.numbers<2>("to", std::nullopt, kAnyFloat);
    put(node, 0, from[0]);
    put(node, 1, from[1]);
    put(node, 2, to[0]);
    put(node, 3, to[1]);
    const JsonValue* at = keys.value().find("from");
    const bool complete = at != nullptr && at->items.size() == 2;
    need(node.numbers[0] != node.numbers[1] || !complete, "from",
         "has two equal numbers: expected two different ones (as float32)");
  } else if (node.type == NodeType::smoothstep) {
    const auto edges = keys.numbers<2>("edges", std::nullopt, kAnyFloat);
    put(node, 0, edges[0]);
    put(node, 1, edges[1]);
    const JsonValue* at = keys.value().find("edges");
    const bool complete = at != nullptr && at->items.size() == 2;
    need(node.numbers[0] < node.numbers[1] || !complete, "edges",
         "does not rise: expected the lower edge first (as float32)");
  }
}

}  // namespace mc::source
