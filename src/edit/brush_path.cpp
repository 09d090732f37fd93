// SPDX-License-Identifier: MIT
#include "edit/brush_path.hpp"

#include <algorithm>
#include <cassert>

#include "base/vectors.hpp"
#include "edit/brush.hpp"

// Paths in dabs and sweeps, by arc length.

namespace mc::edit {

namespace {

/// The radius of a path's brush at a part (0 to 1) of its length: only capsules taper.
double radius_at(const BrushShape& shape, double part) {
  return shape.type == ShapeType::capsule ? shape.radius + (shape.end_radius - shape.radius) * part
                                          : shape.radius;
}

class PathWalk {
 public:
  explicit PathWalk(const std::vector<Vec3>& points) : points_(points) {
    for (std::size_t n = 1; n < points.size(); ++n) {
      ends_.push_back(ends_.back() + mc::length(minus(points[n], points[n - 1])));
    }
  }
  [[nodiscard]] double length() const { return ends_.back(); }
  /// Arc length up to point n.
  [[nodiscard]] double at(std::size_t n) const { return ends_[n]; }
  /// The point at arc length s, which never falls from call to call.
  Vec3 point(double s) {
    while (piece_ + 1 < ends_.size() - 1 && s > ends_[piece_ + 1]) ++piece_;
    const Vec3& a = points_[piece_];
    const double span = ends_[piece_ + 1] - ends_[piece_];
    const double t = span > 0 ? std::min((s - ends_[piece_]) / span, 1.0) : 0;
    return moved(a, minus(points_[piece_ + 1], a), t);
  }

 private:
  const std::vector<Vec3>& points_;
  std::vector<double> ends_{0};
  std::size_t piece_ = 0;
};

std::vector<Stretch> dabs_of(const Edit& edit, double inradius) {
  const BrushPath& path = *edit.path;
  PathWalk walk(path.points);
  const bool ball = is_hull(edit.shape.type);
  const double least = std::max(radius_at(edit.shape, 0), radius_at(edit.shape, 1)) / 16;
  std::vector<Stretch> out;
  for (double s = 0; s <= walk.length() * (1 + 1e-12);) {
    const double radius =
        radius_at(edit.shape, walk.length() > 0 ? std::min(s / walk.length(), 1.0) : 0);
    const Vec3 at = walk.point(s);
    out.push_back({at, at, radius, radius});
    if (out.size() > kMostPositions) refuse_positions();
    const double step = path.spacing * (ball ? std::max(radius, least) : inradius);
    assert(step > 0);
    s += step;
  }
  return out;
}

/// All pieces of a path at once.
std::vector<Stretch> sweep_of(const Edit& edit) {
  const std::vector<Vec3>& points = edit.path->points;
  const PathWalk walk(points);
  const double whole = walk.length() > 0 ? walk.length() : 1;
  std::vector<Stretch> out;
  for (std::size_t n = 1; n < points.size(); ++n) {
    out.push_back({points[n - 1], points[n], radius_at(edit.shape, walk.at(n - 1) / whole),
                   radius_at(edit.shape, walk.at(n) / whole)});
  }
  return out;
}

}  // namespace

bool is_hull(ShapeType type) { return type == ShapeType::sphere || type == ShapeType::capsule; }

void refuse_positions() {
  throw Error(ErrorKind::limit, "edit", "more than 1048576 brush positions",
              "split the path, or space its dabs wider");
}

std::vector<Stretch> stretches(const Edit& edit, double inradius) {
  const BrushShape& s = edit.shape;
  if (edit.path) {
    assert(edit.path->points.size() >= 2);
    return edit.path->mode == PathMode::dabs ? dabs_of(edit, inradius) : sweep_of(edit);
  }
  if (s.type == ShapeType::capsule) return {{s.center, s.end, s.radius, s.end_radius}};
  return {{s.center, s.center, s.radius, s.radius}};
}

}  // namespace mc::edit
