// SPDX-License-Identifier: MIT
#include "edit/symmetry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/sine_cosine.hpp"

// Mirror images and turns of a brush, by arithmetic that is the same everywhere.

namespace mc::edit {

namespace {

/// Of a whole number of parts of a full turn; multiples of a quarter are exact.
base::SineCosine sine_cosine(std::uint32_t part, std::uint32_t of) {
  const std::uint64_t eighths = std::uint64_t{part} * 8;
  const std::uint64_t quarter = (eighths + of) / (2 * std::uint64_t{of});  // the nearest
  const double rest = static_cast<double>(static_cast<std::int64_t>(std::uint64_t{part} * 4) -
                                          static_cast<std::int64_t>(quarter * of)) /
                      static_cast<double>(of);  // of a quarter turn, within 1/2
  return base::sine_cosine(quarter, rest * 1.5707963267948966);
}

/// Back from the mirror images across `axes`.
Affine mirrored(const Mirror& mirror, const std::array<bool, 3>& axes) {
  Affine out;
  for (std::size_t a = 0; a < 3; ++a) {
    if (!axes[a]) continue;
    out.m[5 * a] = -1;
    out.m[4 * a + 3] = 2 * mirror.at[a];
  }
  return out;
}

/// Back from turn n of a radial symmetry.
Affine turned_back(const Radial& radial, std::uint32_t n) {
  const auto [sine, cosine] = sine_cosine(n, radial.count);
  const std::size_t a = (radial.axis + 1) % 3;
  const std::size_t b = (radial.axis + 2) % 3;
  Affine out;
  out.m[5 * a] = cosine;
  out.m[4 * a + b] = sine;
  out.m[4 * b + a] = -sine;
  out.m[5 * b] = cosine;
  out.m[4 * a + 3] = radial.at[a] - (cosine * radial.at[a] + sine * radial.at[b]);
  out.m[4 * b + 3] = radial.at[b] - (cosine * radial.at[b] - sine * radial.at[a]);
  return out;
}

bool nearly_equal(const Affine& a, const Affine& b) {
  for (std::size_t n = 0; n < a.m.size(); ++n) {
    if (!(std::abs(a.m[n] - b.m[n]) <= 1e-9 * (1 + std::abs(a.m[n])))) return false;
  }
  return true;
}

}  // namespace

std::vector<Affine> copies(const Edit& edit) {
  std::vector<Affine> out;
  const Mirror mirror = edit.mirror.value_or(Mirror{});
  const Radial radial = edit.radial.value_or(Radial{});
  for (std::uint32_t n = 0; n < radial.count; ++n) {
    const Affine back = n == 0 ? Affine{} : turned_back(radial, n);
    for (unsigned bits = 0; bits < 8; ++bits) {
      const std::array<bool, 3> axes{(bits & 1U) != 0, (bits & 2U) != 0, (bits & 4U) != 0};
      if ((axes[0] && !mirror.axes[0]) || (axes[1] && !mirror.axes[1]) ||
          (axes[2] && !mirror.axes[2])) {
        continue;
      }
      const Affine map = mirrored(mirror, axes).after(back);
      if (std::none_of(out.begin(), out.end(),
                       [&](const Affine& other) { return nearly_equal(map, other); })) {
        out.push_back(map);
      }
    }
  }
  return out;
}

}  // namespace mc::edit
