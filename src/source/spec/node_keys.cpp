// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mc/base.hpp"
#include "source/spec/nodes.hpp"

// Reads the keys of a node as its row in the table of node types describes them.

namespace mc::source {

namespace {

using graph::KeyKind;
using graph::NodeKey;

constexpr std::size_t kMostPoints = 256;

/// An array of 2 to kMostPoints items; a fault if it is not.
bool are_points(const JsonDocument& document, const JsonValue& found, const char* what) {
  const bool is_array = found.kind == JsonKind::array;
  if (is_array && found.items.size() >= 2 && found.items.size() <= kMostPoints) return true;
  const std::string size = is_array ? " of " + std::to_string(found.items.size()) : "";
  document.fault(found, as_found(found) + size + ": expected an array of 2 to " +
                            std::to_string(kMostPoints) + " " + what);
  return false;
}

/// The number as float; nothing, and a fault is added, if it is not a number that a float can
/// hold.
std::optional<float> as_float(const JsonDocument& document, const JsonValue& item) {
  if (item.kind == JsonKind::number && item.number >= kAnyFloat.lo && item.number <= kAnyFloat.hi) {
    return static_cast<float>(item.number);
  }
  document.fault(item, as_found(item) + ": expected " + kAnyFloat.text);
  return std::nullopt;
}

/// Whether `next` comes after all `stride`-th numbers of the list; a fault if it does not.
bool rises(const JsonDocument& document, const JsonValue& item, const std::vector<float>& list,
           std::size_t stride, float next) {
  if (list.empty() || next > list[list.size() - stride]) {
    return true;
  }
  document.fault(item, "does not rise: expected more than in the one before (as float32)");
  return false;
}

void read_points(const JsonDocument& document, const JsonValue& found, std::vector<float>& list) {
  if (!are_points(document, found, "points")) return;
  for (const JsonValue& item : found.items) {
    if (item.kind != JsonKind::array || item.items.size() != 2) {
      document.fault(item, as_found(item) + ": expected a point, an array of 2 numbers");
      continue;
    }
    const auto x = as_float(document, item.items[0]);
    const auto y = as_float(document, item.items[1]);
    if (x && y && rises(document, item.items[0], list, 2, *x)) {
      list.insert(list.end(), {*x, *y});
    }
  }
}

void read_levels(const JsonDocument& document, const JsonValue& found, std::vector<float>& list) {
  if (!are_points(document, found, "levels")) return;
  for (const JsonValue& item : found.items) {
    const auto level = as_float(document, item);
    if (level && rises(document, item, list, 1, *level)) {
      list.push_back(*level);
    }
  }
}

/// Runs `read`, which may throw an Error of the file that `at` names. What is wrong with a file is
/// a fault of the document.
template <class F>
void read_file(const JsonDocument& document, const JsonValue& at, F&& read) {
  try {
    read();
  } catch (const Error& error) {
    const bool limit = error.kind() == ErrorKind::limit;
    document.fault(at, std::string("cannot be read: ") + error.what(),
                   limit ? error.kind() : ErrorKind::usage);
  }
}

std::vector<std::string> choices_of(const NodeKey& key) {
  std::vector<std::string> choices;
  for (const char* choice : key.choices) {
    if (choice != nullptr) choices.emplace_back(choice);
  }
  return choices;
}

/// The place of the word that the document gives.
std::size_t read_choice(ObjectReader& keys, const NodeKey& key) {
  if (!key.required && !key.fallback && keys.optional(key.name) == nullptr) return 0;
  std::optional<std::size_t> fallback;
  if (key.fallback) fallback = static_cast<std::size_t>((*key.fallback)[0]);
  return keys.choice(key.name, fallback, choices_of(key));
}

void read_numbers(ObjectReader& keys, const NodeKey& key, const NumberRange& range,
                  std::array<double, 12>& out) {
  keys.numbers(key.name, key.required, range, key.one_for_all, std::span(out).first(key.count));
}

double read_integer(ObjectReader& keys, const NodeKey& key) {
  std::optional<std::int64_t> fallback;
  if (key.fallback) fallback = static_cast<std::int64_t>((*key.fallback)[0]);
  return static_cast<double>(keys.integer(key.name, fallback,
                                          static_cast<std::int64_t>(key.range->lo),
                                          static_cast<std::int64_t>(key.range->hi)));
}

double read_number(ObjectReader& keys, const NodeKey& key) {
  if (key.required) return keys.number(key.name, std::nullopt, *key.range);
  return keys.number(key.name, key.fallback ? (*key.fallback)[0] : 0, *key.range);
}

/// Numbers and words into what is known of the key.
void read_value(ObjectReader& keys, const NodeKey& key, graph::GivenKeys::Value& value) {
  const JsonValue* found = keys.value().find(key.name);
  const bool lists = found != nullptr && found->kind == JsonKind::array;
  value.present = found != nullptr;
  value.is_array = lists;
  value.is_complete = lists && found->items.size() == key.count;
  if (key.fallback) std::ranges::copy(*key.fallback, value.numbers.begin());
  switch (key.kind) {
    case KeyKind::integer:
      value.numbers[0] = read_integer(keys, key);
      return;
    case KeyKind::number:
      value.numbers[0] = read_number(keys, key);
      return;
    case KeyKind::numbers:
      return read_numbers(keys, key, *key.range, value.numbers);
    case KeyKind::one_or_more:
      if (lists) return read_numbers(keys, key, *key.items, value.numbers);
      value.numbers[0] = read_number(keys, key);
      return;
    case KeyKind::direction:
      if (lists) return read_numbers(keys, key, *key.range, value.numbers);
      [[fallthrough]];
    case KeyKind::choice:
      value.choice = read_choice(keys, key);
      return;
    default:  // a node, a list or a file
      key.required ? keys.required(key.name) : keys.optional(key.name);
  }
}

/// Puts a value where the key says.
void keep(Node& node, const NodeKey& key, const graph::GivenKeys::Value& value) {
  const bool has_fallback = key.fallback && !key.inherits;
  if (!value.present && !key.required && !has_fallback) return;
  for (std::size_t n = 0; key.at >= 0 && n < key.count; ++n) {
    node.numbers[static_cast<std::size_t>(key.at) + n] = static_cast<float>(value.numbers[n]);
  }
  if (key.set != nullptr) {
    const bool is_word = key.kind == KeyKind::choice;
    key.set(node, is_word ? static_cast<double>(value.choice) : value.numbers[0]);
  }
}

/// Faults of numbers together.
void check_numbers(const JsonDocument& document, const JsonValue& at, const NodeKey& key,
                   const graph::GivenKeys::Value& value) {
  const auto given = std::span(value.numbers).first(key.count);
  const auto is_whole = [](double v) { return std::floor(v) == v; };
  if (key.whole && !std::ranges::all_of(given, is_whole)) {
    document.fault(at, std::string("has a fraction: expected ") + key.range->text);
  }
  const auto is_zero = [](double v) { return std::abs(v) < kPositiveFloat.lo; };
  if (key.any_zero != nullptr && std::ranges::any_of(given, is_zero)) {
    document.fault(at, key.any_zero);
  }
  if (key.all_zero != nullptr && std::ranges::all_of(given, [](double v) { return v == 0; })) {
    document.fault(at, key.all_zero);
  }
}

}  // namespace

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

void NodeLoader::read_key(Node& node, ObjectReader& keys, const NodeKey& key,
                          graph::GivenKeys& given) {
  if (key.applies != nullptr && !key.applies(given)) {
    const JsonValue* found = key.idle == nullptr ? nullptr : keys.optional(key.name);
    if (found != nullptr) document_.fault(*found, key.idle);
    return;
  }
  if (key.kind == KeyKind::node) return take_input(node, keys, key.name);
  if (key.kind == KeyKind::inputs) return take_inputs(node, keys);
  graph::GivenKeys::Value& value = given[key.name];
  read_value(keys, key, value);
  keep(node, key, value);
  if (value.present) check_numbers(document_, *keys.value().find(key.name), key, value);
}

void NodeLoader::read_contents(Node& node, ObjectReader& keys, const graph::NodeKeys& row) {
  std::optional<std::string> part;  // a channel or a grid
  const JsonValue* file = nullptr;
  KeyKind file_kind{};
  for (const NodeKey& key : row) {
    const JsonValue* found = keys.value().find(key.name);
    if (found == nullptr) continue;
    if (key.kind == KeyKind::paired) {
      node.inputs.push_back(load(*found));
    } else if (key.kind == KeyKind::points) {
      read_points(document_, *found, node.list);
    } else if (key.kind == KeyKind::levels) {
      read_levels(document_, *found, node.list);
    } else if (key.kind == KeyKind::text) {
      part = keys.text(key.name, true);
    } else if (key.kind == KeyKind::picture || key.kind == KeyKind::volume) {
      file = keys.text(key.name, true) ? found : nullptr;
      file_kind = key.kind;
    }
  }
  if (file == nullptr) return;
  read_file(document_, *file, [&] {
    if (file_kind == KeyKind::picture) {
      node.raster = files_.picture(file->text, part);
    } else {
      node.volume = files_.volume(file->text, part);
    }
  });
}

void NodeLoader::fill(Node& node, ObjectReader& keys, const graph::NodeRow& row) {
  graph::GivenKeys given(row.keys);
  for (const NodeKey& key : row.keys) {
    read_key(node, keys, key, given);
  }
  if (row.make != nullptr) row.make(node, given);
  bool go_together = true;
  for (const auto& [key, message, shows_value] : given.faults()) {
    const JsonValue& at = key == nullptr ? keys.value() : *keys.value().find(key);
    document_.fault(at, shows_value ? as_found(at) + ": " + message : message);
    go_together = go_together && key != nullptr;
  }
  if (go_together) read_contents(node, keys, row.keys);
}

}  // namespace mc::source
