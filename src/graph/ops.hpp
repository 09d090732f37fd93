// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "graph/bounds.hpp"
#include "graph/program.hpp"
#include "graph/rows.hpp"

namespace mc::graph {

/// What is known of an operation: a row of ops.def.
struct OpRow {
  std::uint8_t n_inputs;
  void (*run)(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
              OutRow out) noexcept;
  Interval (*bounds)(const Instruction& instruction, const WorldBox& world,
                     const Interval (&in)[3]);
};

[[nodiscard]] const OpRow& row_of(Op op) noexcept;

}  // namespace mc::graph
