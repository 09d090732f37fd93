// SPDX-License-Identifier: MIT
#include "source/json/json_tree.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

// nlohmann's SAX parser drives a builder of our own tree. The parser reads through an iterator that
// counts, so the builder knows how far it has come; where a token starts follows from where the one
// before it ended.

namespace mc::source {

namespace {

/// An input iterator over the text that tells how many bytes were taken.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, std::size_t* count) : at_(at), count_(count) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    ++at_;
    ++*count_;
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator old = *this;
    ++*this;
    return old;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  std::size_t* count_;
};

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Offset of the first byte that is not part of well-formed UTF-8; the size where all is well.
std::size_t utf8_prefix(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const auto byte = [&](std::size_t n) {
      return at + n < text.size() ? static_cast<unsigned char>(text[at + n]) : 0U;
    };
    const unsigned first = byte(0);
    const std::size_t length = first < 0x80   ? 1
                               : first < 0xC2 ? 0
                               : first < 0xE0 ? 2
                               : first < 0xF0 ? 3
                               : first < 0xF5 ? 4
                                              : 0;
    bool good = length != 0;
    for (std::size_t n = 1; n < length; ++n) {
      good = good && (byte(n) & 0xC0U) == 0x80U;
    }
    const bool overlong = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xF0 && byte(1) < 0x90);
    const bool surrogate = first == 0xED && byte(1) >= 0xA0;
    const bool too_large = first == 0xF4 && byte(1) >= 0x90;
    if (!good || overlong || surrogate || too_large) {
      return at;
    }
    at += length;
  }
  return at;
}

class Builder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(Faults& faults, const JsonLimits& limits) : faults_(faults), limits_(limits) {}

  std::size_t* count() { return &taken_; }
  JsonValue take_root() { return std::move(root_); }

  bool null() override { return scalar(JsonKind::null, nullptr, 0); }
  bool boolean(bool value) override {
    JsonValue* made = add(JsonKind::boolean);
    if (made != nullptr) {
      made->boolean = value;
    }
    return finish_literal(made);
  }
  bool number_integer(number_integer_t value) override {
    return scalar(JsonKind::number, nullptr, static_cast<double>(value));
  }
  bool number_unsigned(number_unsigned_t value) override {
    return scalar(JsonKind::number, nullptr, static_cast<double>(value));
  }
  bool number_float(number_float_t value, const string_t& /*raw*/) override {
    return scalar(JsonKind::number, nullptr, value);
  }
  bool string(string_t& value) override { return scalar(JsonKind::string, &value, 0); }
  bool binary(binary_t& /*value*/) override { return false; }
  bool start_object(std::size_t /*elements*/) override { return open(JsonKind::object); }
  bool start_array(std::size_t /*elements*/) override { return open(JsonKind::array); }
  bool end_object() override {
    open_.pop_back();
    cursor_ = taken_;
    return true;
  }
  bool end_array() override { return end_object(); }
  bool key(string_t& name) override {
    const std::size_t start = token_start();
    cursor_ = taken_;
    open_.back()->members.push_back({std::move(name), start, {}});
    return true;
  }
  bool parse_error(std::size_t /*position*/, const std::string& /*last_token*/,
                   const nlohmann::detail::exception& exception) override {
    constexpr int kOutOfRange = 406;
    const std::size_t start = token_start();
    if (exception.id == kOutOfRange) {
      faults_.add(start, "",
                  "the number " + number_at(start) + " is too large: expected a finite number");
    } else {
      explain(start);
    }
    return false;
  }

 private:
  /// Where the token just read begins: the first byte after the last one that is neither white
  /// space nor a separator.
  [[nodiscard]] std::size_t token_start() const {
    const std::string_view text = faults_.text();
    std::size_t at = cursor_;
    if (at == 0 && text.starts_with("\xEF\xBB\xBF")) {
      at = 3;
    }
    while (at < text.size() && (is_space(text[at]) || text[at] == ',' || text[at] == ':')) {
      ++at;
    }
    return at;
  }
  [[nodiscard]] std::string number_at(std::size_t start) const {
    const std::string_view rest = faults_.text().substr(start);
    const std::size_t end = rest.find_first_not_of("+-.0123456789eE");
    return std::string(rest.substr(0, std::min<std::size_t>(end, 40)));
  }
  [[nodiscard]] std::string word_at(std::size_t start) const {
    const std::string_view rest = faults_.text().substr(start);
    const std::size_t end = rest.find_first_of(" \t\r\n,:{}[]\"");
    return std::string(
        rest.substr(0, std::max<std::size_t>(end == std::string_view::npos ? rest.size() : end,
                                             rest.empty() ? 0 : 1)));
  }

  void explain(std::size_t start) const;

  JsonValue* add(JsonKind kind) {
    if (++n_values_ > limits_.n_values) {
      faults_.add(token_start(), "",
                  "holds more than " + std::to_string(limits_.n_values) + " values");
      return nullptr;
    }
    JsonValue* made = &root_;
    if (open_.empty()) {
      has_root_ = true;
    } else if (open_.back()->kind == JsonKind::object) {
      made = &open_.back()->members.back().value;
    } else {
      made = &open_.back()->items.emplace_back();
    }
    made->kind = kind;
    made->offset = token_start();
    return made;
  }
  bool scalar(JsonKind kind, std::string* text, double number) {
    JsonValue* made = add(kind);
    if (made == nullptr) {
      return false;
    }
    if (kind == JsonKind::string) {
      made->text = std::move(*text);
      cursor_ = taken_;
      return true;
    }
    if (kind == JsonKind::number) {
      made->number = number;
      made->text = number_at(made->offset);
      cursor_ = made->offset + std::max<std::size_t>(made->text.size(), 1);
      return true;
    }
    return finish_literal(made);
  }
  bool finish_literal(const JsonValue* made) {
    if (made == nullptr) {
      return false;
    }
    cursor_ = taken_;
    return true;
  }
  bool open(JsonKind kind) {
    JsonValue* made = add(kind);
    if (made == nullptr) {
      return false;
    }
    if (open_.size() >= limits_.depth) {
      faults_.add(made->offset, "",
                  "nests deeper than " + std::to_string(limits_.depth) + " levels");
      return false;
    }
    cursor_ = taken_;
    open_.push_back(made);
    return true;
  }

  Faults& faults_;
  JsonLimits limits_;
  JsonValue root_;
  std::vector<JsonValue*> open_;  // ancestors of what is read; none of their lists grows meanwhile
  std::size_t taken_ = 0;
  std::size_t cursor_ = 0;  // end of the last token
  std::size_t n_values_ = 0;
  bool has_root_ = false;
};

/// Says what is wrong with the syntax at `start`, where the parser gave up.
void Builder::explain(std::size_t start) const {
  const std::string_view text = faults_.text();
  const std::string_view rest = text.substr(start);
  const std::string word = word_at(start);
  if (has_root_ && open_.empty()) {
    return faults_.add(start, "", "text after the end of the document: expected nothing more");
  }
  if (taken_ >= text.size() && (rest.empty() || rest.front() == '"')) {
    const std::string what = rest.empty() ? "ends before it is complete" : "ends inside a string";
    return faults_.add(rest.empty() ? text.size() : start, "", "not valid JSON: the text " + what);
  }
  if (start >= taken_ && taken_ > 0) {  // a separator, which token_start() passed over
    const std::string separator(text.substr(taken_ - 1, 1));
    return faults_.add(
        taken_ - 1, "",
        "not valid JSON: found " + in_quotes(separator) + " where a key or value was expected");
  }
  if (word == "NaN" || word == "nan" || word == "Infinity" || word == "-Infinity" ||
      word == "inf" || word == "-inf") {
    return faults_.add(start, "", word + " is no JSON number: expected a finite number");
  }
  if (rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with("#")) {
    return faults_.add(start, "",
                       "not valid JSON: comments are not part of it; use a key that begins with "
                       "\"$\" or \"x-\"");
  }
  if (rest.starts_with("}") || rest.starts_with("]")) {
    return faults_.add(start, "",
                       "not valid JSON: found " + in_quotes(rest.substr(0, 1)) +
                           " where a key or value was expected; look for a comma too many");
  }
  if (rest.starts_with("\"")) {
    return faults_.add(start, "",
                       "not valid JSON: found a string that is damaged or out of place; look for "
                       "a missing comma, colon or quote, a line break or a wrong escape in it");
  }
  faults_.add(
      start, "",
      "not valid JSON: found " + in_quotes(word) + " where a key, value or separator was expected");
}

void report_duplicates(const JsonValue& root, const JsonValue& value, Faults& faults) {
  for (const JsonValue& item : value.items) {
    report_duplicates(root, item, faults);
  }
  std::map<std::string_view, std::size_t> seen;
  for (const JsonMember& member : value.members) {
    const auto [first, is_new] = seen.emplace(member.key, member.key_offset);
    if (!is_new && !is_ignored_key(member.key) && faults.full()) {
      faults.skip();
    } else if (!is_new && !is_ignored_key(member.key)) {
      faults.add(member.key_offset, pointer_to(root, member.value),
                 "duplicate key: it is there already at " + faults.where(first->second));
    }
    report_duplicates(root, member.value, faults);
  }
}

std::string escaped(std::string_view key) {
  std::string out;
  for (const char c : key) {
    if (c == '~') {
      out += "~0";
    } else if (c == '/') {
      out += "~1";
    } else {
      out += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return out;
}

}  // namespace

const JsonValue* JsonValue::find(std::string_view key) const {
  const auto found = std::find_if(members.begin(), members.end(),
                                  [&](const JsonMember& member) { return member.key == key; });
  return found == members.end() ? nullptr : &found->value;
}

const char* kind_name(JsonKind kind) {
  switch (kind) {
    case JsonKind::null:
      return "null";
    case JsonKind::boolean:
      return "a boolean";
    case JsonKind::number:
      return "a number";
    case JsonKind::string:
      return "a string";
    case JsonKind::array:
      return "an array";
    default:
      return "an object";
  }
}

std::string pointer_to(const JsonValue& root, const JsonValue& target) {
  std::string path;
  const JsonValue* at = &root;
  while (at != &target) {
    // Siblings are in the order of the text: the last that starts at or before the target holds it.
    const auto item =
        std::upper_bound(at->items.begin(), at->items.end(), target.offset,
                         [](std::size_t offset, const JsonValue& v) { return offset < v.offset; });
    const auto member = std::upper_bound(
        at->members.begin(), at->members.end(), target.offset,
        [](std::size_t offset, const JsonMember& m) { return offset < m.value.offset; });
    if (item != at->items.begin()) {
      path.append("/").append(std::to_string(std::distance(at->items.begin(), item) - 1));
      at = &*std::prev(item);
    } else if (member != at->members.begin()) {
      path.append("/").append(escaped(std::prev(member)->key));
      at = &std::prev(member)->value;
    } else {
      return path;  // not below the root
    }
  }
  return path;
}

std::optional<JsonValue> parse_json(Faults& faults, const JsonLimits& limits) {
  const std::string_view text = faults.text();
  if (const std::size_t bad = utf8_prefix(text); bad < text.size()) {
    faults.add(bad, "", "not valid UTF-8: expected JSON text in UTF-8");
    return std::nullopt;
  }
  if (std::all_of(text.begin(), text.end(), is_space)) {
    faults.add(0, "", "holds no JSON: expected an object");
    return std::nullopt;
  }
  Builder builder(faults, limits);
  const CountingIterator begin(text.data(), builder.count());
  const CountingIterator end(text.data() + text.size(), builder.count());
  if (!nlohmann::json::sax_parse(begin, end, &builder)) {
    return std::nullopt;
  }
  std::optional<JsonValue> root(builder.take_root());
  report_duplicates(*root, *root, faults);
  return root;
}

}  // namespace mc::source
