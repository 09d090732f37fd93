// SPDX-License-Identifier: MIT
#pragma once

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <random>
#include <string>
#include <type_traits>

// Grids for tests of what reads and writes VDB files.

namespace mc::test {

inline void write_grids(const std::string& path, const openvdb::GridPtrVec& grids) {
  openvdb::io::File file(path);
  file.write(grids);
}

/// Noise in a box across the origin, some of it inactive, and an active and an inactive tile
/// beside.
template <class GridT>
typename GridT::Ptr noise_grid(typename GridT::ValueType background) {
  using Value = typename GridT::ValueType;
  auto grid = GridT::create(background);
  auto accessor = grid->getAccessor();
  std::mt19937 random(7);
  for (int n = 0; n < 3000; ++n) {
    const auto pick = [&] { return static_cast<int>(random() % 30U) - 12; };
    const openvdb::Coord at(pick(), pick(), pick());
    const auto value = static_cast<Value>(random() % (std::is_same_v<Value, bool> ? 2U : 50U));
    if (random() % 3U == 0) {
      accessor.setValueOff(at, value);
    } else {
      accessor.setValueOn(at, value);
    }
  }
  grid->tree().addTile(1, {-40, 0, 8}, static_cast<Value>(1), true);
  grid->tree().addTile(1, {-40, 8, 8}, static_cast<Value>(1), false);
  return grid;
}

}  // namespace mc::test
