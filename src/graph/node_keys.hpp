// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/number_range.hpp"
#include "mc/graph.hpp"

// The keys of a node in an mc-volume document: which there are, what their values may be, and where
// they go in a Node. The reader of documents, the schema, the manual page and the random documents
// of tests all follow these descriptions.

namespace mc::graph {

enum class KeyKind : std::uint8_t {
  node,         ///< any node
  inputs,       ///< a list of nodes or, instead of this key, the two nodes "a" and "b"
  paired,       ///< a node; all keys of this kind are there, or none
  number,       ///< one
  integer,      ///< one
  numbers,      ///< an array of `count` numbers, each within `range`
  one_or_more,  ///< one number within `range`, or `count` of them within `items`
  choice,       ///< one of the words in `choices`
  direction,    ///< one of the words in `choices`, or an array of three numbers
  points,       ///< an array of pairs of numbers, the first of which rise
  levels,       ///< an array of numbers that rise
  text,         ///< not empty
  picture,      ///< the path of a picture
  volume,       ///< the path of a volume
};

class GivenKeys;

/// One key. Made by the functions below, which say what each kind needs.
struct NodeKey {
  const char* name = "";
  KeyKind kind = KeyKind::node;
  bool required = true;
  bool one_way = false;      ///< not required, but one of several keys is
  bool inherits = false;     ///< the fallback is not kept in the node
  bool whole = false;        ///< numbers: integers only
  bool one_for_all = false;  ///< numbers: a single number stands for `count` equal ones
  std::uint8_t count = 1;
  std::int8_t at = -1;  ///< numbers: their first place in Node::numbers; -1: GivenKeys has them
  const NumberRange* range = &kAnyFloat;
  const NumberRange* items = &kAnyFloat;
  std::optional<std::array<double, 3>> fallback{};  ///< numbers; of a choice, its place
  std::array<const char*, 4> choices{};             ///< as many as are not null
  const char* all_zero = nullptr;                   ///< the fault of numbers that are all 0
  const char* any_zero = nullptr;                   ///< that of a number that is 0 or near it
  void (*set)(Node& node, double value) = nullptr;  ///< of a number, or of a choice's place
  /// Whether the key may be there beside what was read before it; null: always. If it may not,
  /// `idle` is the fault, or it counts as an unknown key.
  bool (*applies)(const GivenKeys& given) = nullptr;
  const char* idle = nullptr;
};

/// Up to eight keys, in the order in which they are read and listed in messages.
class NodeKeys {
 public:
  constexpr NodeKeys(std::initializer_list<NodeKey> keys) : n_(keys.size()) {
    std::size_t n = 0;
    for (const NodeKey& key : keys) keys_[n++] = key;
  }
  [[nodiscard]] constexpr const NodeKey* begin() const { return keys_.data(); }
  [[nodiscard]] constexpr const NodeKey* end() const { return keys_.data() + n_; }
  [[nodiscard]] constexpr std::size_t size() const { return n_; }

 private:
  std::array<NodeKey, 8> keys_{};
  std::size_t n_;
};

/// What a document gives for the keys of one node.
class GivenKeys {
 public:
  struct Value {
    bool present = false;  ///< the document has the key
    bool is_array = false;
    bool is_complete = false;  ///< an array of as many items as are expected
    std::array<double, 12> numbers{};
    std::size_t choice = 0;  ///< its place
  };
  struct Fault {
    const char* key;  ///< null: of the node
    std::string message;
    bool shows_value;  ///< the message follows "is 1.5"
  };

  explicit GivenKeys(const NodeKeys& keys) : keys_(keys) {}

  Value& operator[](std::string_view name) { return values_[place_of(name)]; }
  const Value& operator[](std::string_view name) const { return values_[place_of(name)]; }
  [[nodiscard]] double number(std::string_view name) const { return (*this)[name].numbers[0]; }
  [[nodiscard]] Vec3 vector(std::string_view name) const {
    const auto& v = (*this)[name].numbers;
    return {v[0], v[1], v[2]};
  }

  /// Adds a fault to the key, if the document has it.
  void fault(const char* key, std::string message, bool shows_value = false) {
    if ((*this)[key].present) faults_.push_back({key, std::move(message), shows_value});
  }
  /// Adds a fault to the node as a whole: keys do not go together.
  void fault_of_all(std::string message) {
    faults_.push_back({nullptr, std::move(message), false});
  }
  [[nodiscard]] std::span<const Fault> faults() const { return faults_; }

 private:
  [[nodiscard]] std::size_t place_of(std::string_view name) const;

  const NodeKeys& keys_;
  std::array<Value, 8> values_{};
  std::vector<Fault> faults_;
};

inline constexpr NumberRange kFraction{0, 1, false, "a number from 0 to 1"};

/// Any node.
constexpr NodeKey node_key(const char* name) { return {.name = name}; }

/// A number, kept at place `at` of Node::numbers.
constexpr NodeKey number_key(const char* name, int at, const NumberRange& range) {
  NodeKey key{.name = name, .kind = KeyKind::number};
  key.at = static_cast<std::int8_t>(at);
  key.range = &range;
  return key;
}

/// An array of `count` numbers, kept from place `at` of Node::numbers on.
constexpr NodeKey numbers_key(const char* name, int count, int at, const NumberRange& range) {
  NodeKey key = number_key(name, at, range);
  key.kind = KeyKind::numbers;
  key.count = static_cast<std::uint8_t>(count);
  return key;
}

/// As numbers_key(), or a single number that stands for all of them.
constexpr NodeKey sizes_key(const char* name, int count, int at, const NumberRange& range) {
  NodeKey key = numbers_key(name, count, at, range);
  key.one_for_all = true;
  return key;
}

/// One number within `range`, or an array of `count` numbers within `items`.
constexpr NodeKey one_or_more_key(const char* name, int count, int at, const NumberRange& range,
                                  const NumberRange& items) {
  NodeKey key = numbers_key(name, count, at, range);
  key.kind = KeyKind::one_or_more;
  key.items = &items;
  return key;
}

/// An integer, kept by `set`.
constexpr NodeKey integer_key(const char* name, const NumberRange& range,
                              void (*set)(Node&, double)) {
  NodeKey key{.name = name, .kind = KeyKind::integer};
  key.range = &range;
  key.set = set;
  return key;
}

/// One of some words, whose place among them `set` keeps.
constexpr NodeKey choice_key(const char* name, const std::array<const char*, 4>& choices,
                             void (*set)(Node&, double) = nullptr) {
  NodeKey key{.name = name, .kind = KeyKind::choice};
  key.choices = choices;
  key.set = set;
  return key;
}

/// One of some words, or an array of three numbers.
constexpr NodeKey direction_key(const char* name, const std::array<const char*, 4>& choices) {
  NodeKey key = choice_key(name, choices);
  key.kind = KeyKind::direction;
  key.count = 3;
  return key;
}

/// A key of a kind that needs no more than that.
constexpr NodeKey plain_key(const char* name, KeyKind kind) { return {.name = name, .kind = kind}; }

/// Numbers that are integers.
constexpr NodeKey whole(NodeKey key) {
  key.whole = true;
  return key;
}

/// Numbers of which one at least is not 0; `fault` says so.
constexpr NodeKey not_all_zero(NodeKey key, const char* fault) {
  key.all_zero = fault;
  return key;
}

/// Numbers that can be divided by; `fault` says so.
constexpr NodeKey without_zero(NodeKey key, const char* fault) {
  key.any_zero = fault;
  return key;
}

/// The key may be left out, and then has these numbers, or the word at place `x`.
constexpr NodeKey or_else(NodeKey key, double x, double y = 0, double z = 0) {
  key.required = false;
  key.fallback = {{x, y, z}};
  return key;
}

/// The key may be left out, and then the node stays as it is.
constexpr NodeKey or_nothing(NodeKey key) {
  key.required = false;
  return key;
}

/// The key may be left out; it then has the word at place `x`, unless a node above says otherwise.
constexpr NodeKey inherited(NodeKey key, double x) {
  key = or_else(key, x);
  key.inherits = true;
  return key;
}

/// The key may be left out if another one is there; GivenKeys are checked by the row's `make`.
constexpr NodeKey one_way(NodeKey key) {
  key.required = false;
  key.one_way = true;
  return key;
}

/// The key belongs to what `applies` finds in the keys before it.
constexpr NodeKey only_if(NodeKey key, bool (*applies)(const GivenKeys&),
                          const char* idle = nullptr) {
  key.applies = applies;
  key.idle = idle;
  return key;
}

}  // namespace mc::graph
