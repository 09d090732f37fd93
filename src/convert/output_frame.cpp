// SPDX-License-Identifier: MIT
#include "convert/output_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "convert/mesh_formats.hpp"

// Frames are signed permutations of axes, units a scale; both are exact but for the scale itself.

namespace mc::conversion {

namespace {

constexpr Affine kTurnAboutSuperior{{-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0}};  // ras <-> lps
constexpr Affine kLpsToYUp{{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0}};            // (l, s, -p)
constexpr Affine kRasToYUp{{-1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0}};            // (-r, s, a)
constexpr Affine kZUpToYUp{{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0}};            // (x, z, -y)

/// Scaling by division where that is exact more often: 0.5 mm are 0.5 / 1000 m, correctly rounded.
Affine scaled(Affine map, double factor, double divisor) {
  for (double& term : map.m) term = term * factor / divisor;
  return map;
}

Affine converted(const Affine& map, Units from, Units to) {
  if (from == Units::mm && to == Units::m) return scaled(map, 1, 1000);
  if (from == Units::m && to == Units::mm) return scaled(map, 1000, 1);
  return map;
}

/// Permuting and negating rows leaves -0 behind, which would be written as "-0".
Affine without_negative_zero(Affine map) {
  for (double& term : map.m) term += 0.0;
  return map;
}

std::array<Vec3, 8> corners(const IndexBox& box, const Affine& to_world) {
  std::array<Vec3, 8> points;
  for (unsigned n = 0; n < 8; ++n) {
    Vec3 index;
    for (unsigned a = 0; a < 3; ++a) index[a] = ((n >> a) & 1U) != 0 ? box.hi[a] : box.lo[a];
    points[n] = to_world(index);
  }
  return points;
}

void turn_y_up(OutputFrame& at, const FrameChoice& choice) {
  const bool medical = at.source_frame != Frame::none;
  if (at.source_units == Units::unknown && medical) at.source_units = Units::mm;
  if (choice.units == Units::mm && at.source_units == Units::m) {
    throw Error(ErrorKind::usage, "--units", "glTF is in metres, and so is the source",
                fmt::format("choose {} for millimetres",
                            mesh_formats([](const SinkFormat& f) { return !f.y_up_metres; })));
  }
  if (at.source_frame == Frame::lps) at.to_world = kLpsToYUp.after(at.to_world);
  if (at.source_frame == Frame::ras) at.to_world = kRasToYUp.after(at.to_world);
  if (!medical && at.source_up == Up::z) at.to_world = kZUpToYUp.after(at.to_world);
  at.to_world = converted(at.to_world, at.source_units, Units::m);
  at.units = at.source_units == Units::unknown ? Units::unknown : Units::m;
}

void keep_source_axes(OutputFrame& at, const FrameChoice& choice) {
  at.frame = choice.frame.value_or(at.source_frame);
  if (at.frame != at.source_frame) at.to_world = kTurnAboutSuperior.after(at.to_world);
  at.units = choice.units.value_or(at.source_units);
  at.to_world = converted(at.to_world, at.source_units, at.units);
}

bool holds_doubles(const SinkFormat& format) {
  return format.needs({}, true).precision == Precision::f64;
}

}  // namespace

RoundingLoss rounding_loss(const IndexBox& box, const Affine& to_world, Precision precision) {
  double largest = 0;
  for (const Vec3& p : corners(box, to_world)) {
    for (const double c : p) largest = std::max(largest, std::abs(c));
  }
  const double cell = std::min({to_world.spacing(0), to_world.spacing(1), to_world.spacing(2)});
  const bool f32 = precision == Precision::f32;
  const double most =
      f32 ? double{std::numeric_limits<float>::max()} : std::numeric_limits<double>::max();
  if (!(largest <= most)) {
    return {std::numeric_limits<double>::infinity(), true, true};
  }
  // Half the distance between neighbouring numbers: 24 or 53 bits of mantissa, and no finer than
  // the smallest denormal.
  const int lowest = f32 ? -126 : -1022;
  const int exponent = largest > 0 ? std::max(std::ilogb(largest), lowest) : lowest;
  RoundingLoss loss;
  loss.largest_move = std::ldexp(1.0, exponent - (f32 ? 24 : 53));
  loss.matters = loss.largest_move > cell / 8192;
  loss.collapses = loss.largest_move > cell / 8;
  return loss;
}

Vec3 double_origin(const IndexBox& box, const Affine& to_world) {
  Vec3 middle;
  for (std::size_t a = 0; a < 3; ++a) middle[a] = (double{1} * box.lo[a] + box.hi[a]) / 2;
  return to_world(middle);
}

void check_told_apart(const std::string& place, const IndexBox& box, const Affine& to_world,
                      const MeshNeeds& needs, bool asked) {
  Affine stored = to_world;
  if (needs.relative_origin) {
    const Vec3 origin = double_origin(box, stored);
    for (std::size_t a = 0; a < 3; ++a) stored.m[4 * a + 3] -= origin[a];
  }
  if (!rounding_loss(box, stored, needs.precision).collapses) return;
  throw Error(
      asked ? ErrorKind::usage : ErrorKind::limit, place,
      fmt::format("{} coordinates cannot tell the vertices of this volume apart: its cells "
                  "are {:.3g} wide, its corner lies at {:.3g}",
                  needs.precision == Precision::f32 ? "float" : "double", to_world.spacing(0),
                  to_world.m[3]),
      needs.precision == Precision::f32
          ? fmt::format("use {}, or change --spacing and --origin", mesh_formats(holds_doubles))
          : std::string("change --spacing and --origin"));
}

}  // namespace mc::conversion

namespace mc {

OutputFrame output_frame(const Volume& volume, const FrameChoice& choice,
                         const SinkFormat& format) {
  OutputFrame at;
  at.to_world = volume.lattice.to_world;
  at.source_frame = volume.frame == Frame::none ? choice.frame.value_or(Frame::none) : volume.frame;
  at.source_units =
      volume.units == Units::unknown ? choice.units.value_or(Units::unknown) : volume.units;
  if (choice.up && volume.frame != Frame::none) {
    throw Error(
        ErrorKind::usage, "--up",
        std::string("is for sources without a frame, but this one is in ") + name_of(volume.frame));
  }
  at.source_up = choice.up.value_or(Up::y);
  if (format.y_up_metres) {
    conversion::turn_y_up(at, choice);
  } else {
    conversion::keep_source_axes(at, choice);
  }
  at.to_world = conversion::without_negative_zero(at.to_world);
  return at;
}

const char* name_of(Frame frame) {
  switch (frame) {
    case Frame::none:
      return "none";
    case Frame::ras:
      return "ras";
    case Frame::lps:
      return "lps";
  }
  return "none";
}

const char* name_of(Units units) {
  switch (units) {
    case Units::unknown:
      return "unknown";
    case Units::mm:
      return "mm";
    case Units::m:
      return "m";
  }
  return "unknown";
}

const char* name_of(Up up) { return up == Up::y ? "y" : "z"; }

}  // namespace mc
