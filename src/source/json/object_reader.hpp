// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/number_range.hpp"
#include "source/json/json_tree.hpp"

// Reads the keys of one JSON object in a closed format: what is asked for is known, everything else
// is a fault. Every fault is noted and a harmless value returned, so that reading goes on and all
// faults come out together.

namespace mc::source {

/// A parsed text and the place where its faults go.
struct JsonDocument {
  const JsonValue& root;
  Faults& faults;

  /// `message` reads "is 99: expected 1 to 32".
  void fault(const JsonValue& at, const std::string& message,
             ErrorKind kind = ErrorKind::usage) const;
};

/// `is 99`, `is "fast"`, `is an array`: how a message begins.
[[nodiscard]] std::string as_found(const JsonValue& value);

class ObjectReader {
 public:
  /// Where `value` is no object, that is a fault, and every key counts as there and harmless.
  /// `what` names it in messages: "a grid".
  ObjectReader(const JsonDocument& document, const JsonValue& value, const char* what);

  [[nodiscard]] bool is_object() const { return value_.kind == JsonKind::object; }
  [[nodiscard]] const JsonValue& value() const { return value_; }

  /// The key's value, null where it is absent.
  const JsonValue* optional(const char* key);
  /// The same, but absence is a fault.
  const JsonValue* required(const char* key);

  /// Without a fallback the key is required.
  double number(const char* key, std::optional<double> fallback, const NumberRange& range);
  std::int64_t integer(const char* key, std::optional<std::int64_t> fallback, std::int64_t lo,
                       std::int64_t hi);
  /// An array of exactly N numbers; with `one_for_all` a single number stands for N equal ones.
  template <std::size_t N>
  std::array<double, N> numbers(const char* key, std::optional<std::array<double, N>> fallback,
                                const NumberRange& range, bool one_for_all = false) {
    std::array<double, N> out = fallback.value_or(std::array<double, N>{});
    numbers(key, !fallback, range, one_for_all, out);
    return out;
  }
  /// As many numbers as `out` has; where the key is absent it stays as it is.
  void numbers(const char* key, bool is_required, const NumberRange& range, bool one_for_all,
               std::span<double> out);
  /// One of `choices`; its place among them. The fallback is a place too.
  std::size_t choice(const char* key, std::optional<std::size_t> fallback,
                     const std::vector<std::string>& choices);

  /// A text that is not empty; nullopt where it is absent or no such text.
  std::optional<std::string> text(const char* key, bool may_be_absent);

  /// Faults every key that nobody asked for.
  void finish();

 private:
  double read_number(const JsonValue& found, const NumberRange& range);

  const JsonDocument& document_;
  const JsonValue& value_;
  const char* what_;
  std::vector<std::string> known_;
};

}  // namespace mc::source
