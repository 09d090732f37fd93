// SPDX-License-Identifier: MIT
#include "graph/rows.hpp"

// Which family of rows an instruction belongs to.

namespace mc::graph {

void any_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n,
             OutRow out) noexcept {
  switch (instruction.op) {
    case Op::perlin2:
    case Op::perlin3:
    case Op::simplex2:
    case Op::simplex3:
    case Op::open_simplex2:
    case Op::open_simplex3:
    case Op::unity2:
      return gradient_row(instruction, a, b, c, n, out);
    case Op::white2:
    case Op::white3:
    case Op::value2:
    case Op::value3:
    case Op::value_cubic2:
    case Op::value_cubic3:
      return value_row(instruction, a, b, c, n, out);
    case Op::cellular2:
    case Op::cellular3:
      return cellular_row(instruction, a, b, c, n, out);
    case Op::sphere:
    case Op::box:
    case Op::plane:
    case Op::torus:
    case Op::cylinder:
    case Op::cone:
    case Op::capsule:
    case Op::ellipsoid:
    case Op::gyroid:
      return solid_row(instruction, a, b, c, n, out);
    case Op::heightmap:
      return heightmap_row(instruction, a, b, n, out);
    case Op::volume:
      return volume_row(instruction, a, b, c, n, out);
    default:
      return arithmetic_row(instruction, a, b, c, n, out);
  }
}

}  // namespace mc::graph
