// SPDX-License-Identifier: MIT
#include "field/placing.hpp"

#include <algorithm>
#include <cmath>

#include "base/sine_cosine.hpp"
#include "base/vectors.hpp"
#include "mc/field.hpp"

namespace mc::field {

namespace {

/// The angle is reduced in degrees, which is exact.
base::SineCosine sine_cosine(double degrees) {
  const double turn = std::fmod(degrees, 360.0);
  const double quarters = std::floor(turn / 90.0 + 0.5);
  // From -4 to 4; four more leave the turn as it is.
  return base::sine_cosine(static_cast<std::uint64_t>(quarters + 4),
                           (turn - 90.0 * quarters) * 0.017453292519943295);
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

}  // namespace mc::field
