// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "source/json/faults.hpp"

// A JSON text as a tree whose every value and key knows its byte offset, so that a fault can be
// shown where it is. Duplicate keys are kept and reported.

namespace mc::source {

enum class JsonKind : std::uint8_t { null, boolean, number, string, array, object };

struct JsonMember;

struct JsonValue {
  JsonKind kind = JsonKind::null;
  std::size_t offset = 0;  ///< bytes from the start of the text
  bool boolean = false;
  double number = 0;  ///< finite
  std::string text;   ///< of a string; of a number, as it is written
  std::vector<JsonValue> items;
  std::vector<JsonMember> members;  ///< in the order of the text

  /// The first member of that name; null where there is none.
  [[nodiscard]] const JsonValue* find(std::string_view key) const;
};

struct JsonMember {
  std::string key;
  std::size_t key_offset = 0;
  JsonValue value;
};

/// "a string", "an array", ...
[[nodiscard]] const char* kind_name(JsonKind kind);

/// The JSON Pointer (RFC 6901) of `target`, which is `root` or below it.
[[nodiscard]] std::string pointer_to(const JsonValue& root, const JsonValue& target);

struct JsonLimits {
  std::size_t depth = 64;            ///< of arrays and objects
  std::size_t n_values = 1'000'000;  ///< in all
};

/// Parses faults.text(). Returns nothing, and adds the fault, where that is no JSON. Duplicate keys
/// (but those that begin with "$" or "x-") are added too, and the tree is returned all the same.
[[nodiscard]] std::optional<JsonValue> parse_json(Faults& faults, const JsonLimits& limits = {});

/// Keys that every format ignores: they begin with "$" or "x-".
[[nodiscard]] inline bool is_ignored_key(std::string_view key) {
  return key.starts_with("$") || key.starts_with("x-");
}

}  // namespace mc::source
