// SPDX-License-Identifier: MIT
#include "graph/rows.hpp"

// Which family of rows an instruction belongs to.

namespace mc::graph {

void any_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
             OutRow out) noexcept {
  const float frequency = instruction.p[0];
  switch (instruction.op) {
    case Op::perlin2:
      return perlin2_row(a, b, frequency, instruction.seed, n, out);
    case Op::perlin3:
      return perlin3_row(a, b, c, frequency, instruction.seed, n, out);
    case Op::simplex2:
      return simplex2_row(a, b, frequency, instruction.seed, n, out);
    case Op::simplex3:
      return simplex3_row(a, b, c, frequency, instruction.seed, n, out);
    case Op::unity2:
      return unity2_row(a, b, frequency, n, out);
    case Op::sphere:
    case Op::box:
    case Op::plane:
    case Op::torus:
      return solid_row(instruction, a, b, c, n, out);
    default:
      return arithmetic_row(instruction, a, b, c, n, out);
  }
}

}  // namespace mc::graph
