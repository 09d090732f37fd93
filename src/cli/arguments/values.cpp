// SPDX-License-Identifier: MIT
#include "cli/arguments/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <system_error>

#include "base/checked.hpp"
#include "base/text.hpp"

// Numbers, lists, sizes and names as they are typed on a command line.

namespace mc::cli {

namespace {

[[noreturn]] void refuse(std::string_view option, std::string_view fault,
                         std::string_view remedy = {}) {
  throw Error(ErrorKind::usage, option, fault, remedy);
}

/// from_chars knows no plus sign.
std::string_view without_plus(std::string_view text) {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return plus ? text.substr(1) : text;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

Index3 parse_index(std::string_view option, std::string_view text) {
  const auto parts = split(text, ',');
  if (parts.size() != 3) {
    refuse(option,
           fmt::format("'{}' has {} numbers: expected I0,J0,K0:I1,J1,K1", text, parts.size()));
  }
  Index3 index;
  for (std::size_t a = 0; a < 3; ++a) {
    index[a] = static_cast<std::int32_t>(parse_integer(option, parts[a],
                                                       std::numeric_limits<std::int32_t>::min(),
                                                       std::numeric_limits<std::int32_t>::max()));
  }
  return index;
}

}  // namespace

double parse_number(std::string_view option, std::string_view text) {
  const std::string_view digits = without_plus(text);
  double value = 0;
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (fault == std::errc::result_out_of_range) {
    refuse(option, fmt::format("'{}' does not fit a double", text));
  }
  if (fault != std::errc{} || end != digits.data() + digits.size()) {
    refuse(option, fmt::format("'{}' is no number", text));
  }
  if (!std::isfinite(value)) {
    refuse(option, fmt::format("'{}' is not finite: expected a number", text));
  }
  return value;
}

double parse_number_within(std::string_view option, std::string_view text, double lo, double hi) {
  const double value = parse_number(option, text);
  if (!(value >= lo && value <= hi)) {
    if (std::isinf(hi)) {
      refuse(option, fmt::format("{} is out of range: expected {} or more", text, lo));
    }
    refuse(option, fmt::format("{} is out of range: expected {} to {}", text, lo, hi));
  }
  return value;
}

std::int64_t parse_integer(std::string_view option, std::string_view text, std::int64_t lo,
                           std::int64_t hi) {
  const std::string_view digits = without_plus(text);
  std::int64_t value = 0;
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size();
  if (fault == std::errc::invalid_argument || !whole) {
    refuse(option, fmt::format("'{}' is no whole number", text));
  }
  if (fault != std::errc{} || value < lo || value > hi) {
    refuse(option, fmt::format("{} is out of range: expected {} to {}", text, lo, hi));
  }
  return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

Vec3 parse_vector(std::string_view option, std::string_view text) {
  const auto parts = split(text, ',');
  if (parts.size() != 3) {
    refuse(option, fmt::format("'{}' has {} {}: expected three, X,Y,Z", text, parts.size(),
                               parts.size() == 1 ? "number" : "numbers"));
  }
  Vec3 v;
  std::transform(parts.begin(), parts.end(), v.begin(),
                 [&](std::string_view part) { return parse_number(option, part); });
  return v;
}

IndexBox parse_region(std::string_view option, std::string_view text) {
  const auto ends = split(text, ':');
  if (ends.size() != 2) {
    refuse(option, fmt::format("'{}' is no region: expected I0,J0,K0:I1,J1,K1", text));
  }
  const IndexBox box{parse_index(option, ends[0]), parse_index(option, ends[1])};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t extent = box.extent(static_cast<int>(a));
    if (extent < 2 || extent > std::numeric_limits<std::int32_t>::max()) {
      refuse(option,
             fmt::format("{}..{} along {} is too short ({}): expected at least 2 samples",
                         box.lo[a], box.hi[a], "ijk"[a], std::max<std::int64_t>(extent, 0)),
             "both ends are inclusive");
    }
  }
  return box;
}

std::uint64_t parse_size(std::string_view option, std::string_view text) {
  const std::string_view digits = without_plus(text);
  std::uint64_t count = 0;
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), count);
  const std::string_view unit(end, static_cast<std::size_t>(digits.data() + digits.size() - end));
  static constexpr std::array<std::array<std::string_view, 3>, 5> kUnits{
      {{"", "B", "B"}, {"KiB", "K", "k"}, {"MiB", "M", "m"}, {"GiB", "G", "g"}, {"TiB", "T", "t"}}};
  std::optional<std::uint64_t> n_bytes;
  for (std::size_t n = 0; n < kUnits.size() && fault == std::errc{}; ++n) {
    if (std::find(kUnits[n].begin(), kUnits[n].end(), unit) != kUnits[n].end()) {
      n_bytes = base::checked_mul(count, std::uint64_t{1} << (10 * n));
    }
  }
  if (!n_bytes || *n_bytes == 0) {
    refuse(option,
           fmt::format("'{}' is no size: expected a whole number and B, KiB, MiB or GiB", text));
  }
  return *n_bytes;
}

std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known) {
  std::string_view best;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const std::string_view candidate : known) {
    const std::size_t distance = edit_distance(name, candidate);
    const std::size_t near = std::min<std::size_t>(3, std::max(name.size(), candidate.size()) / 2);
    if (distance <= near && distance < least) {
      best = candidate;
      least = distance;
    }
  }
  return best;
}

std::string suggestion(std::string_view name, std::span<const std::string_view> known) {
  const std::string_view near = nearest_name(name, known);
  return near.empty() ? std::string() : fmt::format("did you mean {}?", near);
}

void refuse_choice(std::string_view option, std::string_view text,
                   std::span<const std::string_view> known) {
  refuse(option, fmt::format("unknown value '{}': expected {}", text, base::enumerate(known)),
         suggestion(text, known));
}

}  // namespace mc::cli
