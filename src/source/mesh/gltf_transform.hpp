// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "mc/field.hpp"

namespace mc::source {

/// Where a node of a glTF stands. Row by row, the last column is the translation.
struct GltfTransform {
  std::array<std::array<double, 4>, 3> rows{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  [[nodiscard]] Vec3 operator()(const Vec3& p) const {
    Vec3 q{};
    for (std::size_t r = 0; r < 3; ++r) {
      q[r] = rows[r][0] * p[0] + rows[r][1] * p[1] + rows[r][2] * p[2] + rows[r][3];
    }
    return q;
  }

  [[nodiscard]] GltfTransform after(const GltfTransform& first) const {
    GltfTransform both;
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 4; ++c) {
        both.rows[r][c] = rows[r][0] * first.rows[0][c] + rows[r][1] * first.rows[1][c] +
                          rows[r][2] * first.rows[2][c] + (c == 3 ? rows[r][3] : 0);
      }
    }
    return both;
  }

  /// Cofactors of the linear part: determinant times the inverse's transpose.
  [[nodiscard]] std::array<Vec3, 3> cofactors() const {
    std::array<Vec3, 3> c{};
    for (std::size_t r = 0; r < 3; ++r) {
      const auto& a = rows[(r + 1) % 3];
      const auto& b = rows[(r + 2) % 3];
      for (std::size_t k = 0; k < 3; ++k) {
        c[r][k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
      }
    }
    return c;
  }

  [[nodiscard]] bool only_moves() const {
    const GltfTransform identity;
    return std::ranges::equal(rows, identity.rows, [](const auto& a, const auto& b) {
      return std::equal(a.begin(), a.begin() + 3, b.begin());
    });
  }

  [[nodiscard]] bool is_identity() const {
    return only_moves() && rows[0][3] == 0 && rows[1][3] == 0 && rows[2][3] == 0;
  }

  /// Of the linear part.
  [[nodiscard]] double determinant() const { return determinant(cofactors()); }

  /// Of unit length, where it has any.
  [[nodiscard]] std::array<float, 3> normal(const std::array<float, 3>& given) const {
    if (only_moves()) {
      return given;
    }
    const std::array<Vec3, 3> c = cofactors();
    const double sign = determinant(c) < 0 ? -1 : 1;
    Vec3 turned{};
    for (std::size_t r = 0; r < 3; ++r) {
      turned[r] = sign * (c[r][0] * double{given[0]} + c[r][1] * double{given[1]} +
                          c[r][2] * double{given[2]});
    }
    const double length = std::hypot(turned[0], turned[1], turned[2]);
    const double scale = length > 0 ? 1 / length : 1;
    return {static_cast<float>(turned[0] * scale), static_cast<float>(turned[1] * scale),
            static_cast<float>(turned[2] * scale)};
  }

 private:
  [[nodiscard]] double determinant(const std::array<Vec3, 3>& c) const {
    return rows[0][0] * c[0][0] + rows[0][1] * c[0][1] + rows[0][2] * c[0][2];
  }
};

}  // namespace mc::source
