// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

#include "graph/program.hpp"

namespace mc::graph {

/// All that an instruction's value depends on. Numbers are bits: -0 and NaN are what they are.
struct Recipe {
  Op op;
  std::array<Value, 3> in;
  std::uint32_t seed;
  std::array<std::uint32_t, 6> bits;
  const DataUse* data;

  auto operator<=>(const Recipe&) const = default;  // NOLINT(modernize-use-nullptr): has no pointer
};

[[nodiscard]] Recipe recipe_of(const Instruction& instruction);

/// The same value, bit by bit, with less to do at run time: of constants, which are run now; of a
/// constant and another value, which then need no row for the constant. `code` is what was emitted
/// before it.
[[nodiscard]] Instruction reduced(const Instruction& instruction,
                                  const std::vector<Instruction>& code);

}  // namespace mc::graph
