// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "mc/base.hpp"

// The matrices of transform nodes, worked out in double without the C library's sine, whose last
// bit differs between machines.

namespace mc::field {

using Matrix3 = std::array<Vec3, 3>;  // rows

/// Turns by `degrees` about a unit axis, counter-clockwise seen from its tip. Multiples of 90
/// degrees about x, y or z are exact.
[[nodiscard]] Matrix3 rotation_about(const Vec3& axis, double degrees);

/// First `right`, then `left`.
[[nodiscard]] Matrix3 product(const Matrix3& left, const Matrix3& right);
[[nodiscard]] Matrix3 transposed(const Matrix3& m);
/// None where m is singular.
[[nodiscard]] std::optional<Matrix3> inverse_of(const Matrix3& m);

/// The 3 x 4 float matrix, row by row, of p -> m (p - from) + to.
[[nodiscard]] std::vector<float> placed(const Matrix3& m, const Vec3& from, const Vec3& to);

}  // namespace mc::field
