// SPDX-License-Identifier: MIT
#include "source/json/faults.hpp"

#include <algorithm>

// Where faults are, how they are worded, what the user may have meant.

namespace mc::source {

namespace {

bool starts_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }

/// Insertions, deletions, replacements and swaps of neighbours that lead from a to b.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    last[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      now[j] = std::min({replaced, last[j] + 1, now[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        now[j] = std::min(now[j], before_last[j - 2] + 1);
      }
    }
    std::swap(before_last, last);
    std::swap(last, now);
  }
  return last[b.size()];
}

constexpr std::size_t kLongestName = 64;  // longer ones are never a slip of the pen

}  // namespace

TextPosition position_in(std::string_view text, std::size_t offset) {
  TextPosition at;
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  for (const char c : before) {
    if (c == '\n') {
      ++at.line;
      at.column = 1;
    } else if (starts_character(c)) {
      ++at.column;
    }
  }
  return at;
}

TextPosition Faults::position(std::size_t offset) const {
  TextPosition at = position_in(text_, offset);
  at.line += first_line_ - 1;
  return at;
}

void Faults::add(std::size_t offset, const std::string& pointer, const std::string& message,
                 ErrorKind kind) {
  if (full()) {
    return skip();
  }
  const TextPosition at = position(offset);
  std::string line =
      place_ + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": ";
  if (!label_.empty()) {
    line += label_ + ": ";
  }
  if (!pointer.empty()) {
    line += pointer + ": ";
  }
  faults_.push_back({offset, line + message, kind});
}

std::string Faults::where(std::size_t offset) const {
  const TextPosition at = position(offset);
  return "line " + std::to_string(at.line) + ", column " + std::to_string(at.column);
}

void Faults::throw_if_any() const {
  if (faults_.empty()) {
    return;
  }
  std::vector<Fault> sorted = faults_;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Fault& a, const Fault& b) { return a.offset < b.offset; });
  const bool too_many = sorted.size() > kMost;
  const std::size_t n = too_many ? kMost - 1 : sorted.size();
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < n; ++i) {
    lines.push_back(sorted[i].line);
  }
  if (too_many) {
    lines.push_back(place_ + ": " + std::to_string(sorted.size() - n + n_skipped_) +
                    " more faults; correct those above first");
  }
  const bool limits = std::ranges::all_of(
      sorted, [](const Fault& fault) { return fault.kind == ErrorKind::limit; });
  throw Error(limits ? ErrorKind::limit : ErrorKind::usage, lines);
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  if (name.size() > kLongestName) {
    return {};
  }
  std::string best;
  std::size_t least = std::max<std::size_t>(1, name.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongestName) {
      continue;
    }
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < least && distance < candidate.size()) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

std::string suggestion(std::string_view name, const std::vector<std::string>& candidates) {
  const std::string near = nearest_name(name, candidates);
  if (!near.empty()) {
    return "did you mean " + in_quotes(near) + "?";
  }
  constexpr std::size_t kMostListed = 48;
  std::string list = "expected one of ";
  for (std::size_t i = 0; i < std::min(candidates.size(), kMostListed); ++i) {
    list += (i == 0 ? "" : ", ") + in_quotes(candidates[i]);
  }
  return candidates.size() > kMostListed ? list + ", ..." : list;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  std::string out = "\"";
  std::size_t n = 0;
  for (const char c : text) {
    if (starts_character(c) && ++n > kLongest) {
      out += "...";
      break;
    }
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7F ? '?' : c;
  }
  return out + "\"";
}

}  // namespace mc::source
