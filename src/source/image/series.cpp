// SPDX-License-Identifier: MIT
#include "source/image/series.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <vector>

// Gaps in numbered names.

namespace mc::source {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// A name around its number.
struct Numbered {
  std::string_view before;
  std::string_view digits;
  std::string_view after;
  std::uint64_t number = 0;

  bool operator==(const Numbered& other) const {
    return before == other.before && after == other.after;
  }
};

/// The number that `a` and `b` differ in; nullopt where they differ otherwise.
std::optional<Numbered> numbered(std::string_view a, std::string_view b) {
  const auto same = static_cast<std::size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
  std::size_t begin = same;
  while (begin > 0 && is_digit(a[begin - 1])) --begin;
  std::size_t end = begin;
  while (end < a.size() && is_digit(a[end])) ++end;
  Numbered out{a.substr(0, begin), a.substr(begin, end - begin), a.substr(end)};
  const char* last = out.digits.data() + out.digits.size();
  const auto read = std::from_chars(out.digits.data(), last, out.number);
  if (out.digits.empty() || read.ptr != last || read.ec != std::errc()) return std::nullopt;
  return out;
}

std::string name_with(const Numbered& like, std::uint64_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < like.digits.size()) digits.insert(0, like.digits.size() - digits.size(), '0');
  return std::string(like.before) + digits + std::string(like.after);
}

}  // namespace

std::optional<std::string> missing_name(std::span<const std::string> paths) {
  std::vector<Numbered> names;
  for (std::size_t n = 0; n < paths.size(); ++n) {
    const auto name = numbered(paths[n], paths[n == 0 ? paths.size() - 1 : 0]);
    if (!name || (n > 0 && !(*name == names.front()))) return std::nullopt;
    if (n > 0 && name->number <= names.back().number) return std::nullopt;
    names.push_back(*name);
  }
  if (names.size() < 2) return std::nullopt;
  std::uint64_t step = names[1].number - names[0].number;
  for (std::size_t n = 2; n < names.size(); ++n) {
    step = std::min(step, names[n].number - names[n - 1].number);
  }
  if (names.size() == 2) step = 1;
  for (std::size_t n = 1; n < names.size(); ++n) {
    if (names[n].number - names[n - 1].number != step) {
      return name_with(names[n - 1], names[n - 1].number + step);
    }
  }
  return std::nullopt;
}

}  // namespace mc::source
