// SPDX-License-Identifier: MIT
#include "source/nrrd/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "base/text.hpp"
#include "source/text.hpp"

namespace mc::source {

namespace {

/// Fields that say something about a volume, and those that say nothing to a mesher.
constexpr std::array<std::string_view, 31> kKnown{
    "dimension",       "type",        "block size",   "encoding",         "endian",
    "content",         "min",         "max",          "old min",          "old max",
    "data file",       "line skip",   "byte skip",    "number",           "sizes",
    "spacings",        "thicknesses", "axis mins",    "axis maxs",        "centers",
    "labels",          "units",       "kinds",        "sample units",     "space",
    "space dimension", "space units", "space origin", "space directions", "measurement frame",
    "centerings"};

/// One spelling for each field: "datafile" is "data file", "centerings" is "centers".
std::string field_name(std::string_view written) {
  std::string name = base::lower_case(trimmed(written));
  std::string packed = name;
  std::erase(packed, ' ');
  if (packed == "centerings") {
    return "centers";
  }
  for (const std::string_view known : kKnown) {
    std::string other(known);
    std::erase(other, ' ');
    if (packed == other) {
      return std::string(known);
    }
  }
  return name;
}

template <class T>
std::optional<std::vector<T>> parse_all(std::string_view text) {
  std::vector<T> out;
  for (const std::string& word : split_words(text)) {
    T value{};
    const char* first = word.data() + (word.starts_with('+') ? 1 : 0);
    const auto [end, error] = std::from_chars(first, word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
      return std::nullopt;
    }
    out.push_back(value);
  }
  return out;
}

}  // namespace

NrrdFields::NrrdFields(std::string_view text, std::string place) : place_(std::move(place)) {
  std::size_t at = 0;
  for (std::size_t number = 1;; ++number) {
    const std::size_t end = text.substr(0, kMostBytes).find('\n', at);
    if (end == std::string_view::npos) {
      // A detached header may end with its file, without an empty line.
      if (text.size() > kMostBytes || !values_.contains("data file")) {
        throw Error(ErrorKind::input, place_, "the header of a NRRD file does not end",
                    "the file is damaged or cut off");
      }
      take_line(text.substr(at), number);
      size_bytes_ = text.size();
      return;
    }
    std::string_view line = text.substr(at, end - at);
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    at = end + 1;
    if (line.empty() && !in_list_) {
      size_bytes_ = at;
      return;
    }
    take_line(line, number);
  }
}

void NrrdFields::take_line(std::string_view line, std::size_t number) {
  const auto fault = [&](std::string_view what) {
    return Error(ErrorKind::input, fmt::format("{}:{}", place_, number), what);
  };
  if (number == 1) {
    if (!line.starts_with("NRRD000") || line.size() != 8 || line[7] < '1' || line[7] > '5') {
      throw fault("NRRD0001 to NRRD0005 was expected");
    }
    return;
  }
  if (in_list_) {
    if (!trimmed(line).empty()) {
      list_.emplace_back(trimmed(line));
    }
    return;
  }
  if (line.empty() || line.starts_with('#')) {
    return;
  }
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) {
    throw fault(fmt::format("{}: \"field: value\" was expected", quoted_text(line)));
  }
  if (line.substr(colon).starts_with(":=")) {
    pairs_.emplace(line.substr(0, colon), trimmed(line.substr(colon + 2)));
    return;
  }
  const std::string name = field_name(line.substr(0, colon));
  if (std::ranges::find(kKnown, name) == kKnown.end()) {
    unknown_.push_back(quoted_text(name));
    return;
  }
  const std::string_view value = trimmed(line.substr(colon + 1));
  if (!values_.emplace(name, Value{std::string(value), number}).second) {
    throw fault(fmt::format("{} is given twice", name));
  }
  in_list_ = name == "data file" && (value == "LIST" || value.starts_with("LIST "));
}

std::optional<std::string> NrrdFields::find(std::string_view name) const {
  const auto at = values_.find(name);
  return at == values_.end() ? std::nullopt : std::optional(at->second.text);
}

std::string NrrdFields::required(std::string_view name) const {
  const std::optional<std::string> value = find(name);
  if (!value) {
    throw Error(ErrorKind::input, place_, fmt::format("the NRRD header has no field {}", name));
  }
  return *value;
}

void NrrdFields::fail(std::string_view name, std::string_view fault,
                      std::string_view remedy) const {
  const auto at = values_.find(name);
  const std::string place =
      at == values_.end() ? place_ : fmt::format("{}:{}", place_, at->second.line);
  throw Error(ErrorKind::input, place, fmt::format("{}: {}", name, fault), remedy);
}

std::vector<std::string> split_words(std::string_view text) {
  std::vector<std::string> words;
  while (!(text = trimmed(text)).empty()) {
    const std::size_t end = std::min(text.find_first_of(" \t\r"), text.size());
    words.emplace_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return words;
}

std::optional<std::vector<std::int64_t>> parse_integers(std::string_view text) {
  return parse_all<std::int64_t>(text);
}

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  return parse_all<double>(text);
}

}  // namespace mc::source
