// SPDX-License-Identifier: MIT
#include "graph/prune.hpp"

#include <algorithm>

namespace mc::graph {

namespace {

bool without_zero(Interval a) { return a.lo > 0 || a.hi < 0; }

Instruction constant(const Instruction& instruction, float v) {
  return {.op = Op::fill, .out = instruction.out, .p = {v}};
}

Instruction copy_of(const Instruction& instruction, std::size_t input) {
  return {.op = Op::copy, .out = instruction.out, .in = {instruction.in[input]}, .n_in = 1};
}

/// 0 + v: where a formula adds a zero to its input, which turns -0 into 0.
Instruction plus_zero(const Instruction& instruction, std::size_t input) {
  return {.op = Op::offset, .out = instruction.out, .in = {instruction.in[input]}, .n_in = 1};
}

/// Where the second input does not matter, the first stands in for it.
Instruction without_second(Instruction instruction) {
  instruction.in[1] = instruction.in[0];
  return instruction;
}

}  // namespace

Instruction simplified(const Instruction& instruction, const std::array<Interval, 3>& inputs,
                       Interval value) noexcept {
  const auto& p = instruction.p;
  const auto& [a, b, c] = inputs;
  // The zero of a smoothstep is positive; of others it may have either sign.
  if (value.single() && (value.lo != 0 || instruction.op == Op::smoothstep)) {
    return constant(instruction, value.lo);
  }
  switch (instruction.op) {
    case Op::min:
      if (a.hi <= b.lo) return copy_of(instruction, 0);
      if (b.hi < a.lo) return copy_of(instruction, 1);
      return instruction;
    case Op::max:
      if (a.lo >= b.hi) return copy_of(instruction, 0);
      if (b.lo > a.hi) return copy_of(instruction, 1);
      return instruction;
    case Op::smooth_min:
      if (b.lo - a.hi >= p[0]) return copy_of(instruction, 0);
      if (a.lo - b.hi >= p[0]) return copy_of(instruction, 1);
      return instruction;
    case Op::smooth_max:
      if (a.lo - b.hi >= p[0]) return plus_zero(instruction, 0);
      if (b.lo - a.hi >= p[0]) return plus_zero(instruction, 1);
      return instruction;
    case Op::clamp:
      if (a.lo >= p[0] && a.hi <= p[1]) return copy_of(instruction, 0);
      return instruction;
    case Op::abs:
      if (a.lo > 0) return copy_of(instruction, 0);
      return instruction;
    case Op::select:
      if (c.hi < p[0]) return copy_of(instruction, 0);
      if (c.lo >= p[0]) return copy_of(instruction, 1);
      return instruction;
    case Op::blend:
      if (c.hi <= p[0]) return copy_of(instruction, 0);
      if ((c.lo - p[0]) / p[1] >= 1) return copy_of(instruction, 1);
      return instruction;
    case Op::curve:
      if (a.hi < p[0]) return copy_of(instruction, 1);
      return a.lo >= p[0] ? without_second(instruction) : instruction;
    case Op::mix:
      if (c.single() && c.lo == 0 && value.known() && without_zero(a)) {
        return copy_of(instruction, 0);
      }
      return instruction;
    default:
      return instruction;
  }
}

void Pruner::prune(std::span<const Instruction> code, const std::vector<Interval>& bounds,
                   std::vector<Instruction>& out) {
  out.clear();
  live_[program_.result] = 1;
  for (auto at = code.rbegin(); at != code.rend(); ++at) {
    if (live_[at->out] == 0) continue;
    const auto bound = [&](std::size_t n) { return n < at->n_in ? bounds[at->in[n]] : Interval{}; };
    out.push_back(simplified(*at, {bound(0), bound(1), bound(2)}, bounds[at->out]));
    for (std::size_t n = 0; n < out.back().n_in; ++n) live_[out.back().in[n]] = 1;
  }
  std::reverse(out.begin(), out.end());
  live_[program_.result] = 0;
  for (const Instruction& instruction : out) {
    live_[instruction.out] = 0;
    for (std::size_t n = 0; n < instruction.n_in; ++n) live_[instruction.in[n]] = 0;
  }
}

}  // namespace mc::graph
