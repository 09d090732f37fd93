// SPDX-License-Identifier: MIT
#include "graph/lower.hpp"

#include <algorithm>
#include <cmath>

#include "base/vectors.hpp"

namespace mc::graph {

namespace {

/// The slope at each point: 0 at the ends and at turns, else the harmonic mean of its neighbours,
/// weighted by the intervals' widths.
std::vector<double> monotone_slopes(const std::vector<double>& width,
                                    const std::vector<double>& slope) {
  std::vector<double> at(width.size() + 1, 0.0);
  for (std::size_t n = 1; n < width.size(); ++n) {
    const double before = slope[n - 1];
    const double after = slope[n];
    if ((before > 0 && after > 0) || (before < 0 && after < 0)) {
      const double w1 = 2 * width[n] + width[n - 1];
      const double w2 = width[n] + 2 * width[n - 1];
      at[n] = (w1 + w2) / (w1 / before + w2 / after);
    }
  }
  return at;
}

/// From x to `end`, a cubic in what lies between.
Numbers piece(float x, float end, double c0, double c1 = 0, double c2 = 0, double c3 = 0) {
  return {x,
          static_cast<float>(c0),
          static_cast<float>(c1),
          static_cast<float>(c2),
          static_cast<float>(c3),
          end - x};
}

/// A capsule's ends. Where the ball of one holds the other's, both are that ball's.
struct Ends {
  Vec3 first;
  Vec3 way;
  double length;
  float first_radius;
  float last_radius;
};

Ends ends_of(std::span<const float> list) {
  const Vec3 first{list[0], list[1], list[2]};
  const Vec3 last{list[3], list[4], list[5]};
  const Vec3 way = minus(last, first);
  const double length = mc::length(way);
  if (length > std::abs(double{list[6]} - double{list[7]})) {
    return {first, way, length, list[6], list[7]};
  }
  const float radius = std::max(list[6], list[7]);
  return {list[6] < list[7] ? last : first, {0, 1, 0}, 0, radius, radius};
}

/// The slope's sine and cosine: how the surface leans between the ends.
Numbers capsule_numbers(const Ends& ends) {
  const double fall = double{ends.first_radius} - double{ends.last_radius};
  const double sine = ends.length > 0 ? fall / ends.length : 0;
  return {static_cast<float>(ends.length), ends.first_radius, ends.last_radius,
          static_cast<float>(sine), static_cast<float>(std::sqrt(1 - sine * sine))};
}

/// World points into the frame with this origin and second axis.
std::vector<float> frame_along(const Vec3& origin, const Vec3& way) {
  const Vec3 along = scaled(way, 1 / length(way));
  const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const auto least = std::min_element(along.begin(), along.end(), smaller) - along.begin();
  Vec3 axis{};
  axis[static_cast<std::size_t>(least)] = 1;
  const Vec3 upright = minus(axis, scaled(along, dot(axis, along)));
  const Vec3 across = scaled(upright, 1 / length(upright));
  std::vector<float> matrix;
  for (const Vec3& row : {across, along, cross(across, along)}) {
    for (const double v : row) {
      matrix.push_back(static_cast<float>(v));
    }
    matrix.push_back(static_cast<float>(-dot(row, origin)));
  }
  return matrix;
}

}  // namespace

CurvePieces curve_pieces(std::span<const float> points, CurveShape shape) {
  const std::size_t n_pieces = points.size() / 2 - 1;
  std::vector<double> width(n_pieces);
  std::vector<double> slope(n_pieces);
  for (std::size_t n = 0; n < n_pieces; ++n) {
    width[n] = double{points[2 * n + 2]} - double{points[2 * n]};
    slope[n] = (double{points[2 * n + 3]} - double{points[2 * n + 1]}) / width[n];
  }
  const std::vector<double> at = monotone_slopes(width, slope);
  CurvePieces curve{.first = points[1],
                    .pieces = {},
                    .end_x = points[2 * n_pieces],
                    .last = points[2 * n_pieces + 1]};
  for (std::size_t n = 0; n < n_pieces; ++n) {
    const float x = points[2 * n];
    const float end = points[2 * n + 2];
    const auto y = double{points[2 * n + 1]};
    if (shape == CurveShape::steps) {
      curve.pieces.push_back(piece(x, end, y));
    } else if (shape == CurveShape::linear) {
      curve.pieces.push_back(piece(x, end, y, slope[n]));
    } else {
      const double c2 = (3 * slope[n] - 2 * at[n] - at[n + 1]) / width[n];
      const double c3 = (at[n] + at[n + 1] - 2 * slope[n]) / (width[n] * width[n]);
      curve.pieces.push_back(piece(x, end, y, at[n], c2, c3));
    }
  }
  return curve;
}

CurvePieces terrace_pieces(std::span<const float> levels, float ramp) {
  CurvePieces curve{
      .first = levels.front(), .pieces = {}, .end_x = levels.back(), .last = levels.back()};
  for (std::size_t n = 0; n + 1 < levels.size(); ++n) {
    const float low = levels[n];
    const float high = levels[n + 1];
    const double height = double{high} - double{low};
    const auto foot = static_cast<float>(double{low} + height * (1 - double{ramp}));
    curve.pieces.push_back(piece(low, high, low));
    if (ramp > 0) {
      curve.pieces.push_back(piece(foot, high, low, 1 / double{ramp}));
    }
  }
  return curve;
}

Capsule capsule_of(std::span<const float> list) {
  const Ends ends = ends_of(list);
  return {frame_along(ends.first, ends.way), capsule_numbers(ends)};
}

}  // namespace mc::graph
