// SPDX-License-Identifier: MIT
#include "graph/reduce.hpp"

#include <algorithm>
#include <bit>
#include <optional>

#include "graph/rows.hpp"

// Instructions, one by one, while they are emitted.

namespace mc::graph {

namespace {

bool is_place(Op op) { return op == Op::x || op == Op::y || op == Op::z; }

/// One input that is a constant, and the other.
struct Split {
  float number;
  Value other;
};

/// The formula with its constant in the instruction. Sums and products do not mind their order, and
/// a - b is a + -b.
std::optional<Instruction> with_number(const Instruction& instruction, bool first_is_constant,
                                       const Split& of) {
  const auto made = [&](Op op, float number) {
    return Instruction{
        .op = op, .out = instruction.out, .in = {of.other}, .n_in = 1, .p = {number}};
  };
  switch (instruction.op) {
    case Op::add:
      return made(Op::offset, of.number);
    case Op::sub:
      return first_is_constant ? made(Op::mirror, of.number) : made(Op::offset, -of.number);
    case Op::mul:
      return made(Op::scale, of.number);
    default:
      return std::nullopt;
  }
}

/// What the instruction gives for constant inputs, by the rows that would run it.
float value_of(const Instruction& instruction, const std::vector<Instruction>& code) {
  std::array<std::array<float, kPiece>, 3> rows{};
  std::array<float, kPiece> out{};
  for (std::size_t n = 0; n < instruction.n_in; ++n) rows[n].fill(code[instruction.in[n]].p[0]);
  any_row(instruction, rows[0].data(), rows[1].data(), rows[2].data(), 1, out.data());
  return out[0];
}

}  // namespace

Recipe recipe_of(const Instruction& instruction) {
  return {instruction.op, instruction.in, instruction.seed,
          std::bit_cast<std::array<std::uint32_t, 6>>(instruction.p), instruction.data};
}

Instruction reduced(const Instruction& instruction, const std::vector<Instruction>& code) {
  if (is_place(instruction.op) || instruction.n_in == 0) return instruction;
  const auto is_constant = [&](std::size_t n) { return code[instruction.in[n]].op == Op::fill; };
  std::size_t n_constant = 0;
  for (std::size_t n = 0; n < instruction.n_in; ++n) n_constant += is_constant(n) ? 1 : 0;
  if (n_constant == instruction.n_in) {
    return {.op = Op::fill, .out = instruction.out, .p = {value_of(instruction, code)}};
  }
  if (n_constant == 1 && instruction.n_in == 2) {
    const std::size_t n = is_constant(0) ? 0 : 1;
    const Split split{code[instruction.in[n]].p[0], instruction.in[1 - n]};
    return with_number(instruction, n == 0, split).value_or(instruction);
  }
  return instruction;
}

}  // namespace mc::graph
