// SPDX-License-Identifier: MIT

// Compiled once for every SIMD target: see rows.hpp for what the functions do.

#if defined(MC_GRAPH_ROWS_SOLID_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef MC_GRAPH_ROWS_SOLID_INL
#undef MC_GRAPH_ROWS_SOLID_INL
#else
#define MC_GRAPH_ROWS_SOLID_INL
#endif

#include <hwy/highway.h>

#include <cassert>
#include <cmath>

#include "graph/float_math.hpp"
#include "graph/rows.hpp"

// The solids: exact signed distances, positive inside.
// Source   the usual closed forms (Hart, "Sphere tracing", 1996, appendix A).

HWY_BEFORE_NAMESPACE();
namespace mc::graph {
namespace HWY_NAMESPACE {
namespace {

float box_distance(float x, float y, float z, const Instruction& instruction) noexcept {
  const auto& p = instruction.p;
  const float qx = std::abs(x - p[0]) - p[3] * 0.5F;
  const float qy = std::abs(y - p[1]) - p[4] * 0.5F;
  const float qz = std::abs(z - p[2]) - p[5] * 0.5F;
  const float ox = greatest(qx, 0.0F);
  const float oy = greatest(qy, 0.0F);
  const float oz = greatest(qz, 0.0F);
  const float outside = __builtin_sqrtf((ox * ox + oy * oy) + oz * oz);
  const float inside = least(greatest(qx, greatest(qy, qz)), 0.0F);
  return -(outside + inside);
}

}  // namespace

void solid_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n, OutRow out) {
  const auto& p = instruction.p;
  switch (instruction.op) {
    case Op::sphere:
      for (std::size_t i = 0; i < n; ++i) {
        const float x = a[i] - p[0];
        const float y = b[i] - p[1];
        const float z = c[i] - p[2];
        out[i] = p[3] - __builtin_sqrtf((x * x + y * y) + z * z);
      }
      return;
    case Op::box:
      for (std::size_t i = 0; i < n; ++i) {
        out[i] = box_distance(a[i], b[i], c[i], instruction);
      }
      return;
    case Op::plane:
      for (std::size_t i = 0; i < n; ++i) {
        out[i] = p[3] - ((a[i] * p[0] + b[i] * p[1]) + c[i] * p[2]);
      }
      return;
    case Op::torus:
      for (std::size_t i = 0; i < n; ++i) {
        const float x = a[i] - p[0];
        const float y = b[i] - p[1];
        const float z = c[i] - p[2];
        const float from_ring = __builtin_sqrtf(x * x + z * z) - p[3];
        out[i] = p[4] - __builtin_sqrtf(from_ring * from_ring + y * y);
      }
      return;
    default:
      assert(false && "not a solid");
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace mc::graph
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
