// SPDX-License-Identifier: MIT
#include "source/vdb/placing.hpp"

#include <array>
#include <string>

#include "source/text.hpp"

// Where samples lie: the maps of VDB files. Each is stored with what OpenVDB derives from it, which
// is passed over. VDB multiplies rows by matrices, we matrices by columns.

namespace mc::source {

namespace {

using Vec = std::array<double, 3>;

/// A 4x4 matrix, its translation in the last row.
Affine read_matrix(VdbCursor& cursor, std::string_view what) {
  const auto rows = cursor.number<std::array<std::array<double, 4>, 4>>(what);
  if (rows[0][3] != 0 || rows[1][3] != 0 || rows[2][3] != 0 || rows[3][3] != 1) {
    damaged_vdb(cursor.place(), "a projective map");
  }
  Affine map;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      map.m[4 * row + column] = rows[column][row];
    }
  }
  return map;
}

/// Factors, then spacing, inverse, its square and half of it.
Vec read_scale(VdbCursor& cursor, std::string_view what) {
  const auto scale = cursor.number<Vec>(what);
  cursor.take(4 * sizeof(Vec), what);
  return scale;
}

/// Box, taper, depth, and the linear map behind them.
void pass_frustum(VdbCursor& cursor, std::string_view what) {
  cursor.take(8 * sizeof(double), what);
  read_vdb_map(cursor, what);
}

}  // namespace

std::optional<Affine> read_vdb_map(VdbCursor& cursor, std::string_view what) {
  const std::string kind = cursor.text(what);
  if (kind == "AffineMap" || kind == "UnitaryMap") {
    return read_matrix(cursor, what);
  }
  if (kind == "ScaleMap" || kind == "UniformScaleMap") {
    return Affine::scale_translate(read_scale(cursor, what), {});
  }
  if (kind == "ScaleTranslateMap" || kind == "UniformScaleTranslateMap") {
    const auto origin = cursor.number<Vec>(what);
    return Affine::scale_translate(read_scale(cursor, what), origin);
  }
  if (kind == "TranslationMap") {
    return Affine::scale_translate({1, 1, 1}, cursor.number<Vec>(what));
  }
  if (kind == "NonlinearFrustumMap") {
    pass_frustum(cursor, what);
    return std::nullopt;
  }
  damaged_vdb(cursor.place(), "a map of type " + quoted_text(kind));
}

}  // namespace mc::source
