// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "field/order_key.hpp"
#include "field/sample_scan.hpp"
#include "mc/field.hpp"

// Samples by their rank, without sorting: one pass over them for each 16 bits of keys that order as
// they do. Counts are integers, so the thread count shows nowhere.

namespace mc::field {

inline constexpr unsigned kDigitBits = 16;
inline constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
/// Percentiles that share their passes; bounds the counters to 8 MiB a thread.
inline constexpr std::size_t kGroup = 16;

/// How often each digit follows each of the wanted prefixes of the keys.
template <class T>
class DigitCounts {
 public:
  DigitCounts(const std::vector<std::uint64_t>& prefixes, unsigned shift)
      : prefixes_(&prefixes), shift_(shift), counts_(prefixes.size() * kDigits) {}

  template <bool Swap>
  void row(const std::byte* at, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) weighted(load_sample<T, Swap>(at + i * sizeof(T)), 1);
  }
  void weighted(T value, std::uint64_t n) {
    if (is_nan(value)) return;
    const std::uint64_t key = order_key(value) >> shift_;
    // Two shifts, since the prefix of the first digit has no bits at all.
    const std::uint64_t prefix = key >> (kDigitBits - 1) >> 1;
    for (std::size_t p = 0; p < prefixes_->size(); ++p) {
      if ((*prefixes_)[p] == prefix) counts_[p * kDigits + key % kDigits] += n;
    }
  }
  void end_part(std::size_t /*part*/) {}

  void add_to(std::vector<std::uint64_t>& sum) const {
    for (std::size_t n = 0; n < sum.size(); ++n) sum[n] += counts_[n];
  }

 private:
  const std::vector<std::uint64_t>* prefixes_;
  unsigned shift_;
  std::vector<std::uint64_t> counts_;
};

/// One wanted sample: the digits of its key that are known, and its rank among those that share
/// them.
struct Target {
  std::uint64_t prefix = 0;
  std::uint64_t rank = 0;
};

template <class T>
void find_digit(const VolumeReader& reader, unsigned shift, std::span<Target> targets,
                const Watch& watch) {
  std::vector<std::uint64_t> prefixes;
  for (const Target& target : targets) prefixes.push_back(target.prefix);
  std::sort(prefixes.begin(), prefixes.end());
  prefixes.erase(std::unique(prefixes.begin(), prefixes.end()), prefixes.end());
  std::vector<std::uint64_t> counts(prefixes.size() * kDigits);
  const auto make = [&] { return DigitCounts<T>(prefixes, shift); };
  for (const auto& acc : scan<T>(reader, watch, counts.size() * sizeof(counts[0]), make))
    acc.add_to(counts);
  for (Target& target : targets) {
    const auto at = std::lower_bound(prefixes.begin(), prefixes.end(), target.prefix);
    const std::size_t first = static_cast<std::size_t>(at - prefixes.begin()) * kDigits;
    std::size_t digit = 0;
    while (digit + 1 < kDigits && target.rank >= counts[first + digit]) {
      target.rank -= counts[first + digit++];
    }
    target.prefix = target.prefix << kDigitBits | digit;
  }
}

/// The samples of a volume that have these ranks (from 0) among those that are numbers, in the
/// order of the ranks. Precondition: each rank is below the count of numbers. Cost
/// selection_passes() times reading the samples.
template <class T>
std::vector<T> samples_of_ranks(const VolumeReader& reader, std::span<const std::uint64_t> ranks,
                                const Watch& watch) {
  std::vector<T> out;
  out.reserve(ranks.size());
  for (std::size_t first = 0; first < ranks.size(); first += kGroup) {
    std::vector<Target> targets;
    for (const std::uint64_t rank : ranks.subspan(first, std::min(kGroup, ranks.size() - first))) {
      targets.push_back({0, rank});
    }
    for (unsigned shift = 8 * sizeof(T); shift > 0;) {
      shift -= kDigitBits;
      find_digit<T>(reader, shift, targets, watch);
    }
    for (const Target& target : targets) {
      out.push_back(sample_of_key<T>(static_cast<OrderKey<T>>(target.prefix)));
    }
  }
  return out;
}

/// How often samples_of_ranks() reads the samples.
constexpr std::uint64_t selection_passes(std::size_t sample_bytes, std::size_t n_ranks) {
  const std::size_t n_groups = (n_ranks + kGroup - 1) / kGroup;
  return n_groups * sample_bytes * 8 / kDigitBits;
}

}  // namespace mc::field
