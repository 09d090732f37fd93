// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <cmath>

#include "mc/field.hpp"

// Index boxes and the affine map from lattice indices to the world.

namespace mc {

Affine Affine::scale_translate(const Vec3& spacing, const Vec3& origin) {
  return {{spacing[0], 0, 0, origin[0], 0, spacing[1], 0, origin[1], 0, 0, spacing[2], origin[2]}};
}

Vec3 Affine::operator()(const Vec3& p) const {
  return {((m[0] * p[0] + m[1] * p[1]) + m[2] * p[2]) + m[3],
          ((m[4] * p[0] + m[5] * p[1]) + m[6] * p[2]) + m[7],
          ((m[8] * p[0] + m[9] * p[1]) + m[10] * p[2]) + m[11]};
}

double Affine::determinant() const {
  return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
         m[2] * (m[4] * m[9] - m[5] * m[8]);
}

Affine Affine::after(const Affine& first) const {
  Affine out;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 4; ++c) {
      double sum = c == 3 ? m[4 * r + 3] : 0.0;
      for (std::size_t n = 0; n < 3; ++n) {
        sum += m[4 * r + n] * first.m[4 * n + c];
      }
      out.m[4 * r + c] = sum;
    }
  }
  return out;
}

std::optional<Affine> Affine::inverse() const {
  const auto cofactor = [&](std::size_t row, std::size_t column) {
    const auto at = [&](std::size_t r, std::size_t c) {
      return m[4 * ((row + r) % 3) + (column + c) % 3];
    };
    return at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1);
  };
  const double size = (m[0] * cofactor(0, 0) + m[1] * cofactor(0, 1)) + m[2] * cofactor(0, 2);
  Affine out;
  for (std::size_t r = 0; r < 3; ++r) {
    double* row = &out.m[4 * r];
    for (std::size_t c = 0; c < 3; ++c) row[c] = cofactor(c, r) / size;
    row[3] = -((row[0] * m[3] + row[1] * m[7]) + row[2] * m[11]);
  }
  const bool finite =
      std::all_of(out.m.begin(), out.m.end(), [](double v) { return std::isfinite(v); });
  return finite ? std::optional(out) : std::nullopt;
}

double Affine::spacing(int axis) const {
  const auto a = static_cast<std::size_t>(axis);
  return std::hypot(m[a], m[4 + a], m[8 + a]);
}

bool IndexBox::contains(const Index3& p) const {
  for (std::size_t a = 0; a < 3; ++a) {
    if (p[a] < lo[a] || p[a] > hi[a]) {
      return false;
    }
  }
  return true;
}

bool IndexBox::contains(const IndexBox& other) const {
  return contains(other.lo) && contains(other.hi);
}

Index3 Lattice::dims() const {
  Index3 out{};
  for (int a = 0; a < 3; ++a) {
    const std::int64_t extent = box.extent(a);
    assert(extent >= 0 && extent <= std::numeric_limits<std::int32_t>::max());
    out[static_cast<std::size_t>(a)] = static_cast<std::int32_t>(extent);
  }
  return out;
}

const Volume& volume_of(const VolumeReader& reader) {
  return std::visit([](const auto& port) -> const Volume& { return port->volume(); }, reader);
}

AttributeReaders attributes_of(const VolumeReader& reader) {
  if (const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader)) {
    return (*dense)->attributes();
  }
  if (const auto* sparse = std::get_if<std::unique_ptr<LeafReader>>(&reader)) {
    return (*sparse)->attributes();
  }
  return {};
}

std::uint64_t held_bytes_of(const VolumeReader& reader) {
  if (const auto* dense = std::get_if<std::unique_ptr<SlabReader>>(&reader)) {
    return (*dense)->held_bytes();
  }
  const auto* sparse = std::get_if<std::unique_ptr<LeafReader>>(&reader);
  return sparse != nullptr ? (*sparse)->held_bytes() : 0;
}

bool spool_stream(VolumeReader& reader, Progress& progress) {
  auto* stream = std::get_if<std::unique_ptr<PlaneStream>>(&reader);
  if (stream == nullptr) return false;
  reader = (*stream)->spool(progress);
  return true;
}

}  // namespace mc
