// SPDX-License-Identifier: MIT
#include "source/spec/placing.hpp"

#include <algorithm>
#include <cmath>

#include "mc/field.hpp"

namespace mc::source {

namespace {

double dot(const Vec3& a, const Vec3& b) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }

/// 1 + q/(first (first + 1)) (1 + q/((first + 2) (first + 3)) (1 + ...)): Taylor's series of sine
/// over r (first = 2) and cosine (first = 1) at q = -r^2. Its rest is below 1e-17 for |r| <= pi/4.
double series(double q, int first) {
  double sum = 1;
  for (int n = first + 14; n >= first; n -= 2) {
    sum = 1 + q / (n * (n + 1.0)) * sum;
  }
  return sum;
}

struct SineCosine {
  double sine;
  double cosine;
};

/// The angle is reduced in degrees, which is exact.
SineCosine sine_cosine(double degrees) {
  const double turn = std::fmod(degrees, 360.0);
  const double quarters = std::floor(turn / 90.0 + 0.5);
  const double r = (turn - 90.0 * quarters) * 0.017453292519943295;
  const double sine = r * series(-(r * r), 2);
  const double cosine = series(-(r * r), 1);
  switch (static_cast<int>(quarters) & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

}  // namespace

Matrix3 rotation_about(const Vec3& axis, double degrees) {
  const auto [sine, cosine] = sine_cosine(degrees);
  Matrix3 m{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    const double shared = (axis[i] * axis[j]) * (1 - cosine);
    m[i][i] = cosine + (axis[i] * axis[i]) * (1 - cosine);
    m[i][j] = shared - axis[k] * sine;
    m[j][i] = shared + axis[k] * sine;
  }
  return m;
}

Matrix3 transposed(const Matrix3& m) {
  return {Vec3{m[0][0], m[1][0], m[2][0]}, Vec3{m[0][1], m[1][1], m[2][1]},
          Vec3{m[0][2], m[1][2], m[2][2]}};
}

Matrix3 product(const Matrix3& left, const Matrix3& right) {
  const Matrix3 columns = transposed(right);
  Matrix3 m{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      m[i][j] = dot(left[i], columns[j]);
    }
  }
  return m;
}

std::optional<Matrix3> inverse_of(const Matrix3& m) {
  Affine map;
  for (std::size_t row = 0; row < 3; ++row) std::copy_n(m[row].begin(), 3, &map.m[4 * row]);
  const std::optional<Affine> inverse = map.inverse();
  if (!inverse) return std::nullopt;
  Matrix3 out{};
  for (std::size_t row = 0; row < 3; ++row) std::copy_n(&inverse->m[4 * row], 3, out[row].begin());
  return out;
}

std::vector<float> placed(const Matrix3& m, const Vec3& from, const Vec3& to) {
  std::vector<float> matrix;
  for (std::size_t row = 0; row < 3; ++row) {
    for (const double v : m[row]) {
      matrix.push_back(static_cast<float>(v));
    }
    matrix.push_back(static_cast<float>(to[row] - dot(m[row], from)));
  }
  return matrix;
}

}  // namespace mc::source
