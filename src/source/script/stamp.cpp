// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>

#include "field/placing.hpp"
#include "source/script/brush.hpp"
#include "source/script/record_reader.hpp"

// Stamps: another volume, and where it goes. A place of the stamp's own world is turned and scaled
// about its pivot, then moved; the way back leads from the script's space to the stamp's samples.

namespace mc::source {

namespace {

using field::Matrix3;

constexpr double kMostEntry = 1e100;  // as of SampledVolume

/// p -> m (p - from) + to.
Affine moved(const Matrix3& m, const Vec3& from, const Vec3& to) {
  Affine map;
  for (std::size_t row = 0; row < 3; ++row) {
    const Vec3& r = m[row];
    std::ranges::copy(r, &map.m[4 * row]);
    map.m[4 * row + 3] = to[row] - ((r[0] * from[0] + r[1] * from[1]) + r[2] * from[2]);
  }
  return map;
}

}  // namespace

void RecordReader::fill_stamp(Edit& edit, ObjectReader& keys) {
  const std::optional<std::string> file = keys.text("file", false);
  const std::optional<std::string> grid = keys.text("grid", true);
  const JsonValue* iso = keys.optional("iso");
  const std::size_t side = keys.choice("inside", 0, {"above", "below"});
  if (const JsonValue* carve = keys.optional("carve")) {
    edit.stamp_carves = carve->boolean;
    if (carve->kind != JsonKind::boolean) {
      document_.fault(*carve, as_found(*carve) + ": expected true or false");
    }
  }
  Affine to_index;
  if (file) {
    try {
      const NamedVolume& named = context_.files.named_volume(*file, grid);
      edit.stamp = named.samples;
      to_index = named.samples->to_index;
      edit.stamp_iso = named.iso.value_or(0);
      edit.stamp_above = named.above;
      if (!named.iso && iso == nullptr) {
        document_.fault(keys.value(), "has no \"iso\": " + in_quotes(*file) +
                                          " does not say where its surface is");
      }
    } catch (const Error& error) {
      document_.fault(*keys.value().find("file"), std::string("cannot be read: ") + error.what());
    }
  }
  if (iso != nullptr) edit.stamp_iso = keys.number("iso", 0, kAnyFloat);
  if (keys.value().find("inside") != nullptr) edit.stamp_above = side == 0;
  place_stamp(edit, keys, to_index);
}

void RecordReader::place_stamp(Edit& edit, ObjectReader& keys, const Affine& to_index) {
  constexpr NumberRange kFactor{1e-9, 1e9, false, "a number from 1e-9 to 1e9"};
  const Vec3 to = keys.numbers<3>("translate", Vec3{0, 0, 0}, kPlace);
  const Vec3 pivot = keys.numbers<3>("pivot", Vec3{0, 0, 0}, kPlace);
  const Vec3 factor = keys.numbers<3>("scale", Vec3{1, 1, 1}, kFactor, true);
  const Turn turn = read_rotation(keys, "rotate");
  if (edit.stamp == nullptr) return;
  Matrix3 back{};  // (turn * scale)^-1 = scale^-1 * turn^T
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      back[row][column] = turn.m[3 * column + row] / factor[row];
    }
  }
  edit.stamp_to_index = to_index.after(moved(back, to, pivot));
  const auto is_small = [](double v) { return std::abs(v) <= kMostEntry; };
  if (!std::ranges::all_of(edit.stamp_to_index.m, is_small)) {
    document_.fault(keys.value(), "is placed past all numbers: expected smaller ones");
  }
}

}  // namespace mc::source
