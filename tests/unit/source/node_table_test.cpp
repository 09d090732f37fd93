// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "graph/node_types.hpp"
#include "source/spec/spec.hpp"
#include "support/places.hpp"

// The table of node types against what repeats it for people and for other programs: the schema,
// the manual page, and the faults that the reader of documents finds. With MC_TEST_WRITE=1 in the
// environment the schema and the page's list of keys are written from the table instead.

namespace mc::tests {
namespace {

using graph::KeyKind;
using graph::NodeKey;
using graph::NodeRow;
using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "data/mc-volume.schema.json";
constexpr const char* kPage = "man/mc-volume.5.md";

std::string content_of(const char* name) {
  std::ifstream file(test::source_file(name));
  return {std::istreambuf_iterator<char>(file), {}};
}

bool writes() { return std::getenv("MC_TEST_WRITE") != nullptr; }

void write(const char* name, const std::string& content) {
  std::ofstream(test::source_file(name)) << content;
}

/// What documents may call a key: of "inputs", also the two that stand for it.
std::vector<std::string> names_of(const NodeKey& key) {
  if (key.kind == KeyKind::inputs) return {key.name, "a", "b"};
  return {key.name};
}

std::vector<std::string> words_of(const NodeKey& key) {
  std::vector<std::string> words;
  for (const char* word : key.choices) {
    if (word != nullptr) words.emplace_back(word);
  }
  return words;
}

// The schema.

bool is_any(const NumberRange& range) {
  return range.lo == kAnyFloat.lo && range.hi == kAnyFloat.hi;
}

/// Bounds as JSON writes them: 0, not 0.0.
Json number_of(double v) {
  return std::floor(v) == v && std::abs(v) < 1e15 ? Json(static_cast<std::int64_t>(v)) : Json(v);
}

Json schema_of_number(const NodeKey& key, const NumberRange& range, bool above_zero = false) {
  const bool whole = key.whole || key.kind == KeyKind::integer;
  Json out{{"type", whole ? "integer" : "number"}};
  const bool excludes = above_zero || range.lo_excluded || range.lo == kPositiveFloat.lo;
  out[excludes ? "exclusiveMinimum" : "minimum"] = excludes ? Json(0) : number_of(range.lo);
  out["maximum"] = number_of(range.hi);
  if (key.any_zero != nullptr) out["not"] = {{"const", 0}};
  return out;
}

Json schema_of_item(const NodeKey& key, const NumberRange& range) {
  const bool is_plain = is_any(range) && key.any_zero == nullptr;
  return is_plain ? Json{{"$ref", "#/$defs/number"}} : schema_of_number(key, range);
}

Json schema_of_array(Json items, std::size_t least, std::size_t most) {
  return {{"type", "array"}, {"items", std::move(items)}, {"minItems", least}, {"maxItems", most}};
}

Json schema_of_numbers(const NodeKey& key, const NumberRange& range) {
  Json out = schema_of_array(schema_of_item(key, range), key.count, key.count);
  if (key.all_zero != nullptr) out["contains"] = schema_of_number(key, range, true);
  return out;
}

Json with_default(Json schema, const NodeKey& key, const Json& value) {
  if (key.fallback) schema["default"] = value;
  return schema;
}

Json one_of(Json first, Json second) {
  return {{"oneOf", Json::array({std::move(first), std::move(second)})}};
}

Json schema_of_key(const NodeKey& key) {
  const double fallback = key.fallback ? (*key.fallback)[0] : 0;
  const NumberRange& range = *key.range;
  const Json words{{"enum", words_of(key)}};
  const auto word = [&] { return words_of(key)[static_cast<std::size_t>(fallback)]; };
  switch (key.kind) {
    case KeyKind::node:
    case KeyKind::paired:
      return {{"$ref", "#/$defs/node"}};
    case KeyKind::inputs:
      return {{"type", "array"}, {"items", {{"$ref", "#/$defs/node"}}}, {"minItems", 1}};
    case KeyKind::number:
    case KeyKind::integer:
      if (!key.fallback) return schema_of_item(key, range);
      return with_default(schema_of_number(key, range), key, number_of(fallback));
    case KeyKind::numbers:
      if (!key.one_for_all) return schema_of_numbers(key, range);
      return with_default(one_of(key.all_zero != nullptr ? schema_of_number(key, range, true)
                                                         : schema_of_item(key, range),
                                 schema_of_numbers(key, range)),
                          key, number_of(fallback));
    case KeyKind::one_or_more:
      return one_of(schema_of_item(key, range), schema_of_numbers(key, *key.items));
    case KeyKind::choice:
      return key.fallback ? with_default(words, key, word()) : words;
    case KeyKind::direction:
      return with_default(one_of(words, schema_of_numbers(key, range)), key, word());
    case KeyKind::points:
      return schema_of_array(schema_of_array(schema_of_item(key, range), 2, 2), 2, 256);
    case KeyKind::levels:
      return schema_of_array(schema_of_item(key, range), 2, 256);
    default:  // texts
      return {{"type", "string"}, {"minLength", 1}};
  }
}

Json schema_of_row(const NodeRow& row) {
  Json properties{{"type", {{"const", row.name}}}};
  Json required = Json::array({"type"});
  for (const NodeKey& key : row.keys) {
    properties[key.name] = schema_of_key(key);
    if (key.kind == KeyKind::inputs) {
      properties["a"] = properties["b"] = {{"$ref", "#/$defs/node"}};
    } else if (key.required) {
      required.push_back(key.name);
    }
  }
  return {{"type", "object"},
          {"properties", std::move(properties)},
          {"required", std::move(required)},
          {"patternProperties", {{R"(^(\$|x-))", true}}},
          {"additionalProperties", false}};
}

/// Without the order of members.
nlohmann::json comparable(const Json& schema) { return nlohmann::json::parse(schema.dump()); }

Json condition_of(const std::string& type) {
  return {{"if", {{"required", {"type"}}, {"properties", {{"type", {{"const", type}}}}}}},
          {"then", {{"$ref", "#/$defs/" + type + "-node"}}}};
}

/// Replaces what differs and adds what is missing; other laws of a node's keys are left.
Json updated(Json schema) {
  for (const NodeRow* row : graph::node_rows()) {
    Json definition = schema_of_row(*row);
    const std::string name = std::string(row->name) + "-node";
    Json& definitions = schema["$defs"];
    if (!definitions.contains(name)) {
      definitions["object"]["properties"]["type"]["enum"].push_back(row->name);
      definitions["object"]["allOf"].push_back(condition_of(row->name));
      definitions[name] = definition;
    }
    Json& found = definitions[name];
    for (const char* part : {"properties", "required"}) {
      if (comparable(found[part]) != comparable(definition[part])) found[part] = definition[part];
    }
  }
  return schema;
}

TEST(NodeTable, HasTheKeysAndRangesOfTheSchema) {
  const std::string text = content_of(kSchema);
  const Json schema = Json::parse(text);
  if (writes()) return write(kSchema, updated(schema).dump(1) + "\n");
  EXPECT_EQ(schema.dump(1) + "\n", text) << "writing would change the layout";
  std::set<std::string> types;
  std::set<std::string> definitions{"number", "node", "object"};
  for (const NodeRow* row : graph::node_rows()) {
    SCOPED_TRACE(row->name);
    types.insert(row->name);
    definitions.insert(std::string(row->name) + "-node");
    ASSERT_TRUE(schema["$defs"].contains(std::string(row->name) + "-node"));
    const Json& found = schema["$defs"][std::string(row->name) + "-node"];
    const Json expected = schema_of_row(*row);
    for (const auto& [member, value] : expected.items()) {
      ASSERT_TRUE(found.contains(member)) << member;
      EXPECT_EQ(comparable(found[member]), comparable(value)) << member;
    }
  }
  std::set<std::string> found;
  for (const auto& [name, unused] : schema["$defs"].items()) found.insert(name);
  EXPECT_EQ(found, definitions);
  const Json& object = schema["$defs"]["object"];
  EXPECT_EQ(object["properties"]["type"]["enum"].get<std::set<std::string>>(), types);
  std::set<std::string> chosen;
  for (const Json& branch : object["allOf"]) {
    const std::string type = branch["if"]["properties"]["type"]["const"];
    EXPECT_EQ(branch, condition_of(type));
    chosen.insert(type);
  }
  EXPECT_EQ(chosen, types);
}

// The manual page.

/// Keys that must be there, one of which must, and that may be left out.
using Head = std::pair<std::set<std::string>, std::set<std::string>>;

/// "source, step | levels, [offset, ramp]"
Head head_of(std::string_view text) {
  Head head;
  bool in_brackets = false;
  std::string word;
  for (const char c : std::string(text) + ",") {
    if ((c >= 'a' && c <= 'z') || c == '-') {
      word += c;
      continue;
    }
    if (!word.empty()) (in_brackets ? head.second : head.first).insert(std::exchange(word, ""));
    in_brackets = c == '[' || (in_brackets && c != ']');
  }
  return head;
}

Head head_of(const NodeRow& row) {
  Head head;
  for (const NodeKey& key : row.keys) {
    for (const std::string& name : names_of(key)) {
      (key.required || key.one_way ? head.first : head.second).insert(name);
    }
  }
  return head;
}

/// The page's part about nodes: what each type takes, by the lines above their descriptions.
std::map<std::string, Head> heads_of(const std::string& page) {
  std::map<std::string, Head> heads;
  std::istringstream lines(page.substr(page.find("\n## Arithmetic\n")));
  std::string line;
  std::string last;
  for (; std::getline(lines, line) && line != "# FILES"; last = line) {
    if (!line.starts_with(":   ")) continue;
    const std::size_t end = last.rfind("**");
    const Head head = head_of(std::string_view(last).substr(end + 2));
    for (std::size_t at = 0; at < end; at = last.find("**", at)) {
      const std::size_t close = last.find("**", at + 2);
      heads[last.substr(at + 2, close - at - 2)] = head;
      at = close + 2;
    }
  }
  return heads;
}

TEST(NodeTable, HasTheTypesAndKeysOfTheManualPage) {
  std::map<std::string, Head> expected;
  for (const NodeRow* row : graph::node_rows()) expected[row->name] = head_of(*row);
  EXPECT_EQ(heads_of(content_of(kPage)), expected);
}

/// "a number above 0", without what a float32 can hold of it.
std::string short_range(const NumberRange& range) {
  const std::string text = range.text;
  return is_any(range) ? "a number" : text.substr(0, text.find(" ("));
}

/// "3 numbers above 0"
std::string several(const NodeKey& key, const NumberRange& range) {
  constexpr std::string_view kOne = "a number";
  return std::to_string(key.count) + " numbers" + short_range(range).substr(kOne.size());
}

std::string values_of(const NodeKey& key) {
  const NumberRange& range = *key.range;
  std::string words;
  for (const std::string& word : words_of(key)) {
    words += (words.empty() ? "" : ", ") + ('"' + word + '"');
  }
  switch (key.kind) {
    case KeyKind::node:
    case KeyKind::paired:
      return "a node";
    case KeyKind::inputs:
      return "nodes";
    case KeyKind::number:
    case KeyKind::integer:
      return short_range(range);
    case KeyKind::numbers:
      if (!key.one_for_all) return several(key, range);
      return short_range(range) + " or " + std::to_string(key.count) + " of them";
    case KeyKind::one_or_more:
      return short_range(range) + " or " + several(key, *key.items);
    case KeyKind::choice:
      return words;
    case KeyKind::direction:
      return words + " or " + several(key, range);
    case KeyKind::points:
      return "2 to 256 points";
    case KeyKind::levels:
      return "2 to 256 rising numbers";
    case KeyKind::text:
      return "a text";
    default:
      return "a path";
  }
}

std::string default_of(const NodeKey& key) {
  if (key.required) return "needed";
  if (!key.fallback) return "";
  if (!words_of(key).empty()) return words_of(key)[static_cast<std::size_t>((*key.fallback)[0])];
  std::ostringstream out;
  const bool is_vector = key.kind == KeyKind::numbers && !key.one_for_all;
  for (std::size_t n = 0; n < (is_vector ? key.count : 1U); ++n) {
    out << (n == 0 ? "" : ", ") << (*key.fallback)[n];
  }
  return out.str();
}

/// Lines of the page: each key, what it may hold, its default, and the nodes that have it.
std::string list_of_keys() {
  constexpr std::size_t kWidth = 118;
  std::map<std::string, std::map<std::array<std::string, 2>, std::string>> keys;
  for (const NodeRow* row : graph::node_rows()) {
    for (const NodeKey& key : row->keys) {
      for (const std::string& name : names_of(key)) {
        const bool stands_in = name != key.name;  // a and b for inputs
        std::string& types =
            keys[name][{stands_in ? "a node" : values_of(key),
                        stands_in || key.kind == KeyKind::inputs ? "" : default_of(key)}];
        types += (types.empty() ? "" : " ") + std::string(row->name);
      }
    }
  }
  std::ostringstream out;
  for (const auto& [name, kinds] : keys) {
    for (const auto& [kind, types] : kinds) {
      std::string line =
          "    " + name + ": " + kind[0] + (kind[1].empty() ? "" : "; " + kind[1]) + " (";
      std::istringstream words(types);
      for (std::string word; words >> word; line += word + " ") {
        if (line.size() + word.size() < kWidth) continue;
        out << line << "\n";
        line = "        ";
      }
      line.back() = ')';
      out << line << "\n";
    }
  }
  std::string text = out.str();
  for (std::size_t at = 0; (at = text.find(" \n", at)) != std::string::npos;) text.erase(at, 1);
  return text;
}

TEST(NodeTable, HasTheRangesAndDefaultsOfTheManualPage) {
  const std::string page = content_of(kPage);
  const std::size_t head = page.find("\n## Keys\n");
  ASSERT_NE(head, std::string::npos);
  const std::size_t first = page.find("\n    ", head) + 1;
  const std::size_t end = page.find("\n\n", first) + 1;
  const std::string expected = list_of_keys();
  if (writes()) return write(kPage, page.substr(0, first) + expected + page.substr(end));
  EXPECT_EQ(page.substr(first, end - first), expected);
}

// The reader of documents.

/// What is wrong with a document whose field is this, a line for each fault.
std::string faults_of(const std::string& field) {
  const std::string text = R"({"format": "mc-volume", "version": 1, "grid": {"cells": [1, 1, 1]}, )"
                           R"("field": )" +
                           field + "}";
  std::string faults;
  try {
    (void)source::open_spec_text("v.json", text);
  } catch (const Error& error) {
    for (const std::string& line : error.lines()) faults += line + "\n";
  }
  return faults;
}

std::string node_text(const NodeRow& row, const std::string& keys) {
  return std::string(R"({"type": ")") + row.name + '"' + keys + "}";
}

TEST(NodeTable, HasTheFaultsOfTheReader) {
  std::size_t n_ranges = 0;
  for (const NodeRow* row : graph::node_rows()) {
    SCOPED_TRACE(row->name);
    const auto says = [&](const std::string& keys, const std::string& fault) {
      const std::string found = faults_of(node_text(*row, keys));
      EXPECT_NE(found.find(fault + "\n"), std::string::npos) << fault << "\n" << found;
    };
    const std::string type = std::string("a node of type \"") + row->name + "\"";
    std::string known = "\"type\"";
    for (const NodeKey& key : row->keys) {
      const std::string quoted = std::string("\"") + key.name + "\"";
      if (key.required && key.kind != KeyKind::inputs) {
        says("", "/field: has no " + quoted + ": " + type + " needs it");
      }
      if (key.applies != nullptr && !key.applies(graph::GivenKeys(row->keys))) continue;
      for (const std::string& other : names_of(key)) known += ", \"" + other + "\"";
      if (key.kind != KeyKind::number && key.kind != KeyKind::integer) continue;
      const std::string past = key.range->lo == 0 ? "-1" : "1e300";
      says(", " + quoted + ": " + past,
           std::string("/field/") + key.name + ": is " + past + ": expected " + key.range->text);
      ++n_ranges;
    }
    says(R"(, "zzzzzzzzzzzz": 1)",
         "/field/zzzzzzzzzzzz: unknown key of " + type + "; expected one of " + known);
    const std::string name = row->name;
    if (name.size() < 5) continue;  // too short to be near
    EXPECT_NE(faults_of(R"({"type": ")" + name + "q\"}").find("did you mean \"" + name + "\"?"),
              std::string::npos);
  }
  EXPECT_GT(n_ranges, 40U);
}

}  // namespace
}  // namespace mc::tests
