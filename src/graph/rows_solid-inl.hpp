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

// The solids: signed distances, positive inside; exact, but for the ellipsoid and the gyroid, which
// have no closed form: theirs are exact to first order at the surface.
// Source   the usual closed forms (Hart, "Sphere tracing", 1996, appendix A; Quilez, "Distance
//          functions", for capsule and cone).

HWY_BEFORE_NAMESPACE();
namespace mc::graph::HWY_NAMESPACE {
namespace {

/// The coordinates of a sample from the centre p0, p1, p2.
struct Place {
  float x;
  float y;
  float z;
};

Place from_centre(float x, float y, float z, const Instruction& instruction) noexcept {
  const auto& p = instruction.p;
  return {x - p[0], y - p[1], z - p[2]};
}

float length(float x, float y) noexcept { return __builtin_sqrtf(x * x + y * y); }
float length(float x, float y, float z) noexcept {
  return __builtin_sqrtf((x * x + y * y) + z * z);
}

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

float cylinder_distance(const Place& at, const Instruction& instruction) noexcept {
  const auto& p = instruction.p;
  const float out = length(at.x, at.z) - p[3];
  const float over = std::abs(at.y) - p[4];
  const float outside = length(greatest(out, 0.0F), greatest(over, 0.0F));
  return -(outside + least(greatest(out, over), 0.0F));
}

/// The nearest point lies on a cap or on the slope; both distances are squared until the end.
float cone_distance(const Place& at, const Instruction& instruction) noexcept {
  const auto& p = instruction.p;
  const float radial = length(at.x, at.z);
  const float cap_x = radial - least(radial, at.y < 0.0F ? p[3] : p[4]);
  const float cap_y = std::abs(at.y) - p[5];
  const float slope_x = p[4] - p[3];
  const float slope_y = 2.0F * p[5];
  const float down_x = p[4] - radial;
  const float down_y = p[5] - at.y;
  const float along =
      (down_x * slope_x + down_y * slope_y) / (slope_x * slope_x + slope_y * slope_y);
  const float t = clamped(along, 0.0F, 1.0F);
  const float side_x = slope_x * t - down_x;
  const float side_y = slope_y * t - down_y;
  const float cap = cap_x * cap_x + cap_y * cap_y;
  const float side = side_x * side_x + side_y * side_y;
  const float distance = __builtin_sqrtf(least(side, cap));
  return side_x < 0.0F && cap_y < 0.0F ? distance : -distance;
}

float capsule_distance(float x, float y, float z, const Instruction& instruction) noexcept {
  const auto& p = instruction.p;
  const float radial = length(x, z);
  const float along = y * p[4] - radial * p[3];  // the slope's own coordinate
  const float bottom = p[1] - length(radial, y);
  const float top = p[2] - length(radial, y - p[0]);
  const float side = p[1] - (radial * p[4] + y * p[3]);
  const float upper = along > p[4] * p[0] ? top : side;
  return along < 0.0F ? bottom : upper;
}

/// (1 - k0) k0 / k1 with k0 = |p / r|, k1 = |p / r^2|: the implicit function over its slope. k0 /
/// k1 is within the radii and held there, whatever underflows; at the centre, where it has no
/// value, the least radius.
float ellipsoid_distance(const Place& at, const Instruction& instruction) noexcept {
  const auto& p = instruction.p;
  const float low = least(p[3], least(p[4], p[5]));
  const float high = greatest(p[3], greatest(p[4], p[5]));
  const float x = at.x / p[3];
  const float y = at.y / p[4];
  const float z = at.z / p[5];
  const float k0 = length(x, y, z);
  const float k1 = length(x / p[3], y / p[4], z / p[5]);
  const float distance = (1.0F - k0) * clamped(k0 / k1, low, high);
  return k0 < 0x1p-30F ? low : distance;
}

/// g over its slope, which on the surface is from sqrt 2 to sqrt 3; held at 1 or more, so that the
/// value stays bounded where g has its extremes.
float gyroid_distance(const Place& at, float k) noexcept {
  constexpr float kQuarter = 1.57079637F;
  const float sx = exact_sin(at.x * k);
  const float sy = exact_sin(at.y * k);
  const float sz = exact_sin(at.z * k);
  const float cx = exact_sin(at.x * k + kQuarter);
  const float cy = exact_sin(at.y * k + kQuarter);
  const float cz = exact_sin(at.z * k + kQuarter);
  const float g = (sx * cy + sy * cz) + sz * cx;
  const float gx = cx * cy - sz * sx;
  const float gy = cy * cz - sx * sy;
  const float gz = cz * cx - sy * sz;
  const float slope2 = (gx * gx + gy * gy) + gz * gz;
  return g / (k * __builtin_sqrtf(greatest(slope2, 1.0F)));
}

template <class F>
void map_places(const Instruction& instruction, Row a, Row b, Row c, std::size_t n, OutRow out,
                F distance) {
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = distance(from_centre(a[i], b[i], c[i], instruction));
  }
}

}  // namespace

void solid_row(const Instruction& instruction, Row a, Row b, Row c, std::size_t n, OutRow out) {
  const auto& p = instruction.p;
  switch (instruction.op) {
    case Op::sphere:
      return map_places(instruction, a, b, c, n, out,
                        [&](const Place& at) { return p[3] - length(at.x, at.y, at.z); });
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
      return map_places(instruction, a, b, c, n, out, [&](const Place& at) {
        return p[4] - length(length(at.x, at.z) - p[3], at.y);
      });
    case Op::cylinder:
      return map_places(instruction, a, b, c, n, out,
                        [&](const Place& at) { return cylinder_distance(at, instruction); });
    case Op::cone:
      return map_places(instruction, a, b, c, n, out,
                        [&](const Place& at) { return cone_distance(at, instruction); });
    case Op::ellipsoid:
      return map_places(instruction, a, b, c, n, out,
                        [&](const Place& at) { return ellipsoid_distance(at, instruction); });
    case Op::gyroid:
      return map_places(instruction, a, b, c, n, out,
                        [&](const Place& at) { return gyroid_distance(at, p[3]); });
    case Op::capsule:
      for (std::size_t i = 0; i < n; ++i) {
        out[i] = capsule_distance(a[i], b[i], c[i], instruction);
      }
      return;
    default:
      assert(false && "not a solid");
  }
}

}  // namespace mc::graph::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // include guard that foreach_target.h flips
