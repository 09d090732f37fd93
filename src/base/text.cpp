// SPDX-License-Identifier: MIT
#include "base/text.hpp"

#include <algorithm>

namespace mc::base {

std::string lower_case(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return out;
}

std::string extension_of(std::string_view path) {
  const std::string_view name = path.substr(path.rfind('/') + 1);
  const std::size_t dot = name.rfind('.');
  return lower_case(dot == std::string_view::npos ? "" : name.substr(dot + 1));
}

bool has_word(std::string_view words, std::string_view word) {
  while (!word.empty() && !words.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    if (words.substr(0, end) == word) return true;
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return false;
}

std::string enumerate(std::span<const std::string_view> names, std::string_view last) {
  std::string text;
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (n > 0) text += n + 1 == names.size() ? " " + std::string(last) + " " : ", ";
    text += names[n];
  }
  return text;
}

}  // namespace mc::base
