// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/vectors.hpp"
#include "edit/brush.hpp"
#include "edit/brush_path.hpp"
#include "edit/symmetry.hpp"

// Where a brush works: its path in dabs or as a sweep, copied by symmetry, each position with the
// samples that it can reach.

namespace mc::edit {

namespace {

double largest_spacing(const Affine& map) {
  double most = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    most = std::max(most, length({map.m[a], map.m[4 + a], map.m[8 + a]}));
  }
  return most;
}

/// The largest ball in a frustum, whose middle is on the axis: it touches both caps, or the larger
/// one and the slope.
double cone_inradius(double below, double above, double half) {
  const double large = std::max(below, above);
  const double fall = (large - std::min(below, above)) / (2 * half);
  const double cosine = 1 / __builtin_sqrt(1 + fall * fall);
  return std::min(half, large * cosine / (1 + fall * cosine));
}

Brush brush_of(const Edit& edit, const EditRules& rules) {
  const BrushShape& s = edit.shape;
  Brush out;
  out.falloff = edit.falloff;
  out.inradius = s.radius;
  switch (s.type) {
    case ShapeType::sphere:
    case ShapeType::capsule:
      break;
    case ShapeType::box:
      out.form = Form::box;
      out.rounding = s.rounding;
      for (std::size_t a = 0; a < 3; ++a) out.half[a] = s.size[a] / 2 - s.rounding;
      out.inradius = std::min({s.size[0], s.size[1], s.size[2]}) / 2;
      break;
    case ShapeType::cylinder:
      out.form = Form::cylinder;
      out.rounding = s.rounding;
      out.half = {s.radius - s.rounding, s.height / 2 - s.rounding, 0};
      out.inradius = std::min(s.radius, s.height / 2);
      break;
    case ShapeType::cone:
      out.form = Form::cone;
      out.half = {s.radius, s.end_radius, s.height / 2};
      out.inradius = cone_inradius(s.radius, s.end_radius, s.height / 2);
      break;
    case ShapeType::ellipsoid:
      out.form = Form::ellipsoid;
      out.half = s.size;
      out.inradius = std::min({s.size[0], s.size[1], s.size[2]});
      break;
    case ShapeType::plane:
      out.form = Form::plane;
      break;
    case ShapeType::node:
      out.form = Form::node;
      out.node = s.field.get();
      for (std::size_t a = 0; a < 3; ++a) {
        out.middle[a] = (s.bounds[0][a] + s.bounds[1][a]) / 2;
        out.half[a] = (s.bounds[1][a] - s.bounds[0][a]) / 2;
      }
      break;
  }
  if (edit.op == EditOp::stamp && edit.falloff.type == FalloffType::none) {
    out.form = Form::everywhere;
  } else if (edit.blend == Blend::csg && edit.falloff.type == FalloffType::none) {
    out.reach = edit.smooth + 3 * largest_spacing(rules.to_world);
  }
  return out;
}

/// The frame of a plane: its normal is y.
Turn facing(const Vec3& n) {
  // The axis that is least along the normal gives the second direction.
  const std::size_t a = std::abs(n[0]) <= std::abs(n[1]) && std::abs(n[0]) <= std::abs(n[2]) ? 0
                        : std::abs(n[2]) <= std::abs(n[1])                                   ? 2
                                                                                             : 1;
  Vec3 x{};
  x[a] = 1;
  x = moved(x, n, -n[a]);
  const double scale = length(x);
  for (double& v : x) v /= scale;
  const Vec3 z = cross(x, n);
  return {{x[0], n[0], z[0], x[1], n[1], z[1], x[2], n[2], z[2]}};
}

/// From the world to a turned frame at `center`.
Affine frame_at(const Turn& turn, const Vec3& center) {
  const auto& t = turn.m;
  const Affine turned{{t[0], t[3], t[6], 0, t[1], t[4], t[7], 0, t[2], t[5], t[8], 0}};
  const Affine moved_back{{1, 0, 0, -center[0], 0, 1, 0, -center[1], 0, 0, 1, -center[2]}};
  return turned.after(moved_back);
}

/// Fills what a ball needs to know of its line. One that holds all the others stands alone.
void set_line(const Stretch& piece, Position& out) {
  const Vec3 way = minus(piece.to, piece.from);
  const double whole = length(way);
  out.radius = piece.radius;
  if (!(whole > std::abs(piece.radius - piece.end_radius))) {
    out.radius = std::max(piece.radius, piece.end_radius);
    return;
  }
  out.length = whole;
  out.taper = (piece.radius - piece.end_radius) / whole;
  out.slope = out.taper / __builtin_sqrt(1 - out.taper * out.taper);
  for (std::size_t a = 0; a < 3; ++a) out.along[a] = way[a] / whole;
}

Position position_of(const Stretch& piece, const Edit& edit, Brush& brush) {
  Position out;
  Stretch line = piece;
  if (!is_hull(edit.shape.type)) line.radius = line.end_radius = 0;
  set_line(line, out);
  const bool starts_at_end = out.length == 0 && line.end_radius > line.radius;
  const Turn turn = brush.form == Form::plane ? facing(edit.shape.normal) : edit.shape.turn;
  const bool turned = !is_hull(edit.shape.type);
  out.to_local = frame_at(turned ? turn : Turn{}, starts_at_end ? piece.to : piece.from);
  if (turned && out.length > 0) {
    const Vec3 u = out.along;
    const auto& t = turn.m;
    out.along = {dot({t[0], t[3], t[6]}, u), dot({t[1], t[4], t[7]}, u),
                 dot({t[2], t[5], t[8]}, u)};
  }
  return out;
}

/// Half extents of a brush that is no ball, with its reach, in its own frame.
Vec3 half_extents(const Brush& brush) {
  const double grown = brush.rounding + brush.reach;
  const Vec3& h = brush.half;
  switch (brush.form) {
    case Form::cylinder:
      return {h[0] + grown, h[1] + grown, h[0] + grown};
    case Form::cone: {
      const double radius = std::max(h[0], h[1]) + grown;
      return {radius, h[2] + grown, radius};
    }
    case Form::ellipsoid: {  // where (k0 - 1) times the least radius is the reach
      const double scale = 1 + grown / std::min({h[0], h[1], h[2]});
      return {h[0] * scale, h[1] * scale, h[2] * scale};
    }
    default:
      return {h[0] + grown, h[1] + grown, h[2] + grown};
  }
}

/// Whole numbers in [from, to], with some room for rounding, of an axis of a box.
void clip_axis(double from, double to, std::size_t axis, IndexBox& box) {
  const double room = 1e-9 * (1 + std::abs(from) + std::abs(to));
  const double lo = std::max(std::ceil(from - room), static_cast<double>(box.lo[axis]));
  const double hi = std::min(std::floor(to + room), static_cast<double>(box.hi[axis]));
  if (!(lo <= hi)) {
    box = IndexBox{};
    return;
  }
  box.lo[axis] = static_cast<std::int32_t>(lo);
  box.hi[axis] = static_cast<std::int32_t>(hi);
}

/// Samples that a position can reach, within `box`.
IndexBox reached_box(const Brush& brush, const Position& at, IndexBox box) {
  if (brush.form == Form::plane) return box;
  const Affine to_index = inverse(at.to_local);
  const Vec3 end = moved({}, at.along, at.length);
  const double end_radius = at.radius - at.taper * at.length;
  for (std::size_t a = 0; a < 3 && !is_empty(box); ++a) {
    const Vec3 row{to_index.m[4 * a], to_index.m[4 * a + 1], to_index.m[4 * a + 2]};
    const double from = to_index.m[4 * a + 3];
    const double to = from + dot(row, end);
    double first = 0;
    double last = 0;
    if (brush.form == Form::ball) {
      first = (at.radius + brush.reach) * length(row);
      last = (end_radius + brush.reach) * length(row);
      clip_axis(std::min(from - first, to - last), std::max(from + first, to + last), a, box);
      continue;
    }
    const Vec3 half = half_extents(brush);
    const double middle = dot(row, brush.middle);
    const double apart =
        (std::abs(row[0]) * half[0] + std::abs(row[1]) * half[1]) + std::abs(row[2]) * half[2];
    clip_axis(std::min(from, to) + middle - apart, std::max(from, to) + middle + apart, a, box);
  }
  return box;
}

/// Samples within a stamp's own.
IndexBox stamped_box(const Position& at, const Index3& dims, IndexBox box) {
  const Affine to_index = inverse(at.to_stamp);
  for (std::size_t a = 0; a < 3 && !is_empty(box); ++a) {
    double middle = to_index.m[4 * a + 3];
    double apart = 0;
    for (std::size_t b = 0; b < 3; ++b) {
      const double half = (dims[b] - 1) / 2.0;
      middle += to_index.m[4 * a + b] * half;
      apart += std::abs(to_index.m[4 * a + b]) * half;
    }
    clip_axis(middle - apart, middle + apart, a, box);
  }
  return box;
}

/// One position for each stretch, each under one map back from a copy.
class Layout {
 public:
  Layout(const Edit& edit, const EditRules& rules, const IndexBox& within, Stroke& out)
      : edit_(edit), rules_(rules), within_(within), out_(out) {}

  void add(const Stretch& piece, const Affine& back) {
    Position at = position_of(piece, edit_, out_.brush);
    const Affine home = back.after(rules_.to_world);
    at.to_local = at.to_local.after(home);
    at.group = out_.n_groups;
    if (edit_.op == EditOp::stamp) {
      Affine moved_back;  // the stamp's own place is where the shape's center is
      for (std::size_t a = 0; a < 3; ++a) {
        moved_back.m[4 * a + 3] = -(piece.from[a] - edit_.shape.center[a]);
      }
      at.to_stamp = edit_.stamp_to_index.after(moved_back.after(home));
      at.box = stamped_box(at, edit_.stamp->dims, within_);
    }
    if (out_.brush.form != Form::everywhere) {
      const IndexBox room = edit_.op == EditOp::stamp ? at.box : within_;
      at.box = is_empty(room) ? IndexBox{} : reached_box(out_.brush, at, room);
    }
    reaches_ = reaches_ || !is_empty(at.box);
    if (out_.positions.size() >= kMostPositions) refuse_positions();
    out_.positions.push_back(at);
  }
  void end_group() {
    if (!reaches_) ++out_.n_outside;
    reaches_ = false;
    ++out_.n_groups;
  }

 private:
  const Edit& edit_;
  const EditRules& rules_;
  IndexBox within_;
  Stroke& out_;
  bool reaches_ = false;
};

}  // namespace

Affine inverse(const Affine& map) {
  const auto& m = map.m;
  Affine out;
  const double determinant = map.determinant();
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      const double cofactor = m[4 * c1 + r1] * m[4 * c2 + r2] - m[4 * c1 + r2] * m[4 * c2 + r1];
      out.m[4 * r + c] = cofactor / determinant;
    }
    const Vec3 row{out.m[4 * r], out.m[4 * r + 1], out.m[4 * r + 2]};
    out.m[4 * r + 3] = -dot(row, {m[3], m[7], m[11]});
  }
  return out;
}

Stroke lay_out(const Edit& edit, const EditRules& rules, const IndexBox& within,
               const IndexBox& bounded) {
  Stroke out;
  out.brush = brush_of(edit, rules);
  const std::vector<Stretch> pieces = stretches(edit, out.brush.inradius);
  const std::vector<Affine> backs = copies(edit);
  Layout layout(edit, rules, out.brush.form == Form::plane ? bounded : within, out);
  if (edit.path && edit.path->mode == PathMode::sweep) {
    for (const Affine& back : backs) {
      for (const Stretch& piece : pieces) layout.add(piece, back);
      layout.end_group();
    }
    return out;
  }
  for (const Stretch& piece : pieces) {
    for (const Affine& back : backs) {
      layout.add(piece, back);
      layout.end_group();
    }
  }
  return out;
}

}  // namespace mc::edit
