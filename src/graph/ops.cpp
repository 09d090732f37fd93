// SPDX-License-Identifier: MIT
#include "graph/ops.hpp"

#include <algorithm>
#include <cassert>
#include <iterator>

#include "graph/bounds_arithmetic.hpp"
#include "graph/bounds_data.hpp"
#include "graph/bounds_noise.hpp"
#include "graph/bounds_shape.hpp"
#include "graph/float_math.hpp"
#include "graph/interval_math.hpp"

// The table of operations, in the order of Op, and what is looked up in it.

namespace mc::graph {

namespace {

constexpr OpRow kRows[] = {
#define MC_OP(name, n_inputs, run, ...)                                              \
  {n_inputs, run,                                                                    \
   []([[maybe_unused]] const Instruction& i, [[maybe_unused]] const WorldBox& world, \
      [[maybe_unused]] const Interval(&in)[3]) -> Interval {                         \
     [[maybe_unused]] const auto& p = i.p;                                           \
     [[maybe_unused]] const auto& [a, b, c] = in;                                    \
     return __VA_ARGS__;                                                             \
   }},
#include "graph/ops.def"
};

/// The operations that Machine runs: coordinates and copies.
constexpr bool has_no_kernel(Op op) {
  return op == Op::x || op == Op::y || op == Op::z || op == Op::copy;
}

constexpr bool rows_are_complete() {
  for (std::size_t n = 0; n < std::size(kRows); ++n) {
    const bool runs = kRows[n].run != nullptr;
    if (runs == has_no_kernel(Op(n)) || kRows[n].n_inputs > Instruction{}.in.size()) return false;
  }
  return true;
}
static_assert(rows_are_complete(), "an operation has no kernel, or more inputs than fit");

}  // namespace

const OpRow& row_of(Op op) noexcept {
  assert(static_cast<std::size_t>(op) < std::size(kRows));
  return kRows[static_cast<std::size_t>(op)];
}

// Position-independent code keeps row_of() from being inlined, which any_row() is called too often
// for: once for each operation and row of samples.

void any_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
             OutRow out) noexcept {
  const OpRow& row = kRows[static_cast<std::size_t>(instruction.op)];
  assert(row.run != nullptr);
  row.run(instruction, a, b, c, n, out);
}

Interval bounds_of(const Instruction& instruction, const WorldBox& world, Interval a, Interval b,
                   Interval c) noexcept {
  const Interval in[3] = {a, b, c};
  assert(instruction.n_in <= std::size(in));
  for (std::size_t n = 0; n < instruction.n_in; ++n) {
    if (!in[n].known()) return kUnknown;
  }
  return kRows[static_cast<std::size_t>(instruction.op)].bounds(instruction, world, in);
}

}  // namespace mc::graph
