// SPDX-License-Identifier: MIT
#include "graph/machine.hpp"

#include <algorithm>
#include <cassert>

#include "graph/rows.hpp"

namespace mc::graph {

void Machine::run(std::span<const Instruction> code) {
  assert(n_ <= kPiece);
  for (const Instruction& instruction : code) {
    float* out = registers_.data() + std::size_t{program_.homes[instruction.out]} * kPiece;
    if (shares_y_ && program_.uniform[instruction.out]) {
      run(instruction, 1, out);
      std::fill(out + 1, out + n_, *out);
    } else {
      run(instruction, n_, out);
    }
  }
}

void Machine::run(const Instruction& instruction, std::size_t n, float* out) const {
  switch (instruction.op) {
    case Op::x:
      std::copy_n(x_.begin(), n, out);
      return;
    case Op::y:
      std::copy_n(y_.begin(), n, out);  // n is 1 where they share it
      return;
    case Op::z:
      std::copy_n(z_.begin(), n, out);
      return;
    case Op::copy:
      std::copy_n(row(instruction.in[0]), n, out);
      return;
    default:
      return any_row(instruction, row(instruction.in[0]), row(instruction.in[1]),
                     row(instruction.in[2]), n, out);
  }
}

}  // namespace mc::graph
