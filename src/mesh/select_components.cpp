// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cstddef>
#include <numeric>

#include "mc/components.hpp"

namespace mc {

namespace {

/// Rounds to 20 significant bits.
double rounded(double size) {
  constexpr std::uint64_t kDropped = (std::uint64_t{1} << 33U) - 1;  // of 53
  const auto bits = std::bit_cast<std::uint64_t>(size) + (kDropped + 1) / 2;
  return std::bit_cast<double>(bits & ~kDropped);
}

}  // namespace

std::vector<std::uint8_t> select_components(std::span<const double> sizes, const KeepRule& rule) {
  std::vector<std::uint8_t> kept(sizes.size(), 0);
  if (rule.by != KeepRule::By::count) {
    std::ranges::transform(sizes, kept.begin(), [&](double size) {
      return static_cast<std::uint8_t>(size >= rule.least ? 1 : 0);
    });
    return kept;
  }
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto n = static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(rule.n, sizes.size()));
  const auto is_larger = [&](std::size_t a, std::size_t b) {
    const double x = rounded(sizes[a]), y = rounded(sizes[b]);
    return x > y || (x == y && a < b);
  };
  std::nth_element(order.begin(), order.begin() + n, order.end(), is_larger);
  for (auto at = order.begin(); at != order.begin() + n; ++at) kept[*at] = 1;
  return kept;
}

}  // namespace mc
