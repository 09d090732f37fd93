// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "mc/base.hpp"

// The parts of a cell of eight samples, as types that are also indices of arrays.
//
//         6 ---3--- 7            corner c lies at (c & 1, c >> 1 & 1, c >> 2 & 1);
//        /|        /|            bit c of a case is set where corner c is above.
//       6 |       7 |
//      /  10     /  11           edges 0..3 run along i, 4..7 along j, 8..11 along k, each ordered
//     4 ---2--- 5   |            by its lower corner: the low bit is the nearer axis.
//     |   |     |   |
//     |   2 --1-|-- 3
//     8  /      9  /             k
//     | 4       | 5              | / j
//     |/        |/               |/
//     0 ---0--- 1                +--- i

namespace mc::extraction {

inline constexpr std::size_t kCorners = 8;
inline constexpr std::size_t kEdges = 12;

/// i, j or k: an index into Index3 and Vec3.
class Axis {
 public:
  constexpr explicit Axis(std::size_t n) : n_(static_cast<std::uint8_t>(n)) { assert(n < 3); }
  constexpr operator std::size_t() const { return n_; }

 private:
  std::uint8_t n_;
};
inline constexpr std::array<Axis, 3> kAxes{Axis(0), Axis(1), Axis(2)};

class Corner {
 public:
  constexpr explicit Corner(std::size_t n) : n_(static_cast<std::uint8_t>(n)) {
    assert(n < kCorners);
  }
  constexpr operator std::size_t() const { return n_; }
  /// 0 or 1: where it lies along an axis.
  [[nodiscard]] constexpr std::int32_t along(Axis axis) const { return n_ >> axis & 1; }
  /// The corner at the other end of the edge that leaves this one upwards along an axis.
  [[nodiscard]] constexpr Corner next(Axis axis) const {
    return Corner(n_ | std::size_t{1} << axis);
  }
  /// The lattice index of this corner of a cell.
  [[nodiscard]] constexpr Index3 of(const Index3& cell) const {
    return {cell[0] + along(kAxes[0]), cell[1] + along(kAxes[1]), cell[2] + along(kAxes[2])};
  }

 private:
  std::uint8_t n_;
};

class CellEdge {
 public:
  constexpr CellEdge() = default;
  constexpr explicit CellEdge(std::size_t n) : n_(static_cast<std::uint8_t>(n)) {
    assert(n < kEdges);
  }
  constexpr operator std::size_t() const { return n_; }
  [[nodiscard]] constexpr Axis axis() const { return Axis(n_ / 4U); }
  [[nodiscard]] constexpr Corner lower() const {
    const std::size_t low = n_ & 1U;
    const std::size_t high = n_ >> 1U & 1U;
    constexpr std::array<std::array<std::size_t, 2>, 3> kWeights{{{2, 4}, {1, 4}, {1, 2}}};
    return Corner(low * kWeights[axis()][0] + high * kWeights[axis()][1]);
  }
  [[nodiscard]] constexpr Corner upper() const { return lower().next(axis()); }

 private:
  std::uint8_t n_ = 0;
};

/// Which corners of a cell are above: one of 256.
class CellCase {
 public:
  constexpr CellCase() = default;
  constexpr explicit CellCase(std::size_t bits) : bits_(static_cast<std::uint8_t>(bits)) {
    assert(bits < 256);
  }
  constexpr operator std::size_t() const { return bits_; }
  [[nodiscard]] constexpr bool above(Corner corner) const { return (bits_ >> corner & 1) != 0; }
  [[nodiscard]] constexpr bool crosses(CellEdge edge) const {
    return above(edge.lower()) != above(edge.upper());
  }
  constexpr void set(Corner corner, bool is_above) {
    bits_ = static_cast<std::uint8_t>(bits_ | static_cast<unsigned>(is_above) << corner);
  }

 private:
  std::uint8_t bits_ = 0;
};

}  // namespace mc::extraction
