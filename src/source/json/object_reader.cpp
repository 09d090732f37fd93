// SPDX-License-Identifier: MIT
#include "source/json/object_reader.hpp"

#include <algorithm>
#include <cmath>

// Closed objects: known keys, ranges, and the wording of what was expected.

namespace mc::source {

void JsonDocument::fault(const JsonValue& at, const std::string& message, ErrorKind kind) const {
  if (faults.full()) {
    return faults.skip();
  }
  faults.add(at.offset, pointer_to(root, at), message, kind);
}

std::string as_found(const JsonValue& value) {
  switch (value.kind) {
    case JsonKind::number:
      return "is " + value.text;
    case JsonKind::string:
      return "is " + in_quotes(value.text);
    case JsonKind::boolean:
      return value.boolean ? "is true" : "is false";
    default:
      return std::string("is ") + kind_name(value.kind);
  }
}

ObjectReader::ObjectReader(const JsonDocument& document, const JsonValue& value, const char* what)
    : document_(document), value_(value), what_(what) {
  if (!is_object()) {
    document_.fault(value_, as_found(value_) + ": expected an object, " + what_);
  }
}

const JsonValue* ObjectReader::optional(const char* key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) {
    known_.emplace_back(key);
  }
  return value_.find(key);
}

const JsonValue* ObjectReader::required(const char* key) {
  const JsonValue* found = optional(key);
  if (found == nullptr && is_object()) {
    document_.fault(value_, std::string("has no ") + in_quotes(key) + ": " + what_ + " needs it");
  }
  return found;
}

double ObjectReader::read_number(const JsonValue& found, const NumberRange& range) {
  const bool is_number = found.kind == JsonKind::number;
  const double v = found.number;
  const bool above = range.lo_excluded ? v > range.lo : v >= range.lo;
  if (!is_number || !above || v > range.hi) {
    document_.fault(found, as_found(found) + ": expected " + range.text);
    return std::clamp(1.0, range.lo, range.hi);
  }
  return v;
}

double ObjectReader::number(const char* key, std::optional<double> fallback,
                            const NumberRange& range) {
  const JsonValue* found = fallback ? optional(key) : required(key);
  return found == nullptr ? fallback.value_or(1.0) : read_number(*found, range);
}

std::int64_t ObjectReader::integer(const char* key, std::optional<std::int64_t> fallback,
                                   std::int64_t lo, std::int64_t hi) {
  const JsonValue* found = fallback ? optional(key) : required(key);
  if (found == nullptr) {
    return fallback.value_or(lo);
  }
  const double v = found->number;
  const bool whole = found->kind == JsonKind::number && std::floor(v) == v;
  if (!whole || v < static_cast<double>(lo) || v > static_cast<double>(hi)) {
    const std::string range =
        lo == hi ? std::to_string(lo)
                 : "an integer from " + std::to_string(lo) + " to " + std::to_string(hi);
    document_.fault(*found, as_found(*found) + ": expected " + range);
    return lo;
  }
  return static_cast<std::int64_t>(v);
}

void ObjectReader::numbers(const char* key, bool is_required, const NumberRange& range,
                           bool one_for_all, std::span<double> out) {
  const JsonValue* found = is_required ? required(key) : optional(key);
  if (found == nullptr) return;
  if (one_for_all && found->kind == JsonKind::number) {
    std::ranges::fill(out, read_number(*found, range));
    return;
  }
  std::ranges::fill(out, std::clamp(1.0, range.lo, range.hi));
  if (found->kind != JsonKind::array || found->items.size() != out.size()) {
    const std::string size =
        found->kind == JsonKind::array ? " of " + std::to_string(found->items.size()) : "";
    document_.fault(*found, as_found(*found) + size + ": expected " +
                                (one_for_all ? "a number or " : "") + "an array of " +
                                std::to_string(out.size()) + " numbers");
    return;
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = read_number(found->items[i], range);
  }
}

std::size_t ObjectReader::choice(const char* key, std::optional<std::size_t> fallback,
                                 const std::vector<std::string>& choices) {
  const JsonValue* found = fallback ? optional(key) : required(key);
  if (found == nullptr) {
    return fallback.value_or(0);
  }
  const auto at = std::find(choices.begin(), choices.end(), found->text);
  if (found->kind == JsonKind::string && at != choices.end()) {
    return static_cast<std::size_t>(at - choices.begin());
  }
  std::string list;
  for (const std::string& choice : choices) {
    list += (list.empty() ? "" : ", ") + in_quotes(choice);
  }
  document_.fault(*found,
                  as_found(*found) + ": expected " + (choices.size() == 1 ? "" : "one of ") + list);
  return fallback.value_or(0);
}

std::optional<std::string> ObjectReader::text(const char* key, bool may_be_absent) {
  const JsonValue* found = may_be_absent ? optional(key) : required(key);
  if (found == nullptr) {
    return std::nullopt;
  }
  if (found->kind != JsonKind::string || found->text.empty()) {
    document_.fault(*found, as_found(*found) + ": expected a text that is not empty");
    return std::nullopt;
  }
  return found->text;
}

void ObjectReader::finish() {
  for (const JsonMember& member : value_.members) {
    const bool known = std::find(known_.begin(), known_.end(), member.key) != known_.end();
    if (known || is_ignored_key(member.key)) {
      continue;
    }
    if (document_.faults.full()) {
      document_.faults.skip();
      continue;
    }
    document_.faults.add(
        member.key_offset, pointer_to(document_.root, member.value),
        std::string("unknown key of ") + what_ + "; " + suggestion(member.key, known_));
  }
}

}  // namespace mc::source
