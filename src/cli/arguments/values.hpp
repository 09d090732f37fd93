// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mc/base.hpp"
#include "mc/field.hpp"

// Text that the user typed, to values. `option` names the option in messages. Numbers are read in
// the C locale, whatever the environment says. Every fault is an Error of kind usage.

namespace mc::cli {

/// A number that is finite, after an optional sign; the whole text must be used up.
double parse_number(std::string_view option, std::string_view text);

/// A finite number within [lo, hi].
double parse_number_within(std::string_view option, std::string_view text, double lo, double hi);

/// A whole decimal number within [lo, hi].
std::int64_t parse_integer(std::string_view option, std::string_view text, std::int64_t lo,
                           std::int64_t hi);

/// The parts between separators; "a,,b" has an empty part.
std::vector<std::string_view> split(std::string_view text, char separator);

/// "X,Y,Z".
Vec3 parse_vector(std::string_view option, std::string_view text);

/// "I0,J0,K0:I1,J1,K1", both ends inclusive, at least two samples along each axis.
IndexBox parse_region(std::string_view option, std::string_view text);

/// Bytes: a whole number, and perhaps B, KiB, MiB, GiB, TiB (or K, M, G, T, which mean the same).
std::uint64_t parse_size(std::string_view option, std::string_view text);

/// The known name nearest to `name` by edit distance, or "" if none is near.
/// Source   Levenshtein 1966. Near: at most three edits, and half the longer name's letters.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known);

/// "; did you mean X?" without the "; ", or "" if nothing is near.
std::string suggestion(std::string_view name, std::span<const std::string_view> known);

[[noreturn]] void refuse_choice(std::string_view option, std::string_view text,
                                std::span<const std::string_view> known);

/// One of the listed names.
template <class T, std::size_t N>
T parse_choice(std::string_view option, std::string_view text,
               const std::array<std::pair<std::string_view, T>, N>& choices) {
  std::array<std::string_view, N> names;
  for (std::size_t n = 0; n < N; ++n) {
    if (choices[n].first == text) return choices[n].second;
    names[n] = choices[n].first;
  }
  refuse_choice(option, text, names);
}

}  // namespace mc::cli
