// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "source/mesh/mesh_input.hpp"

// What a PLY file declares: elements, how many of each there are, and their properties in order.
// Names lie in the input's text.

namespace mc::source {

enum class PlyType : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

constexpr bool is_real(PlyType type) { return type == PlyType::f32 || type == PlyType::f64; }

constexpr std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 10> kSizes = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

struct PlyProperty {
  std::string_view name;
  PlyType type{};
  std::optional<PlyType> count;  ///< of a list
};

struct PlyElement {
  std::string_view name;
  std::uint64_t n = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  bool text = false;
  std::endian order = std::endian::little;
  std::vector<PlyElement> elements;
  std::size_t size = 0;  ///< bytes, to the first of the body
};

/// Errors   input: what is no header of PLY 1.0; triangle strips.
[[nodiscard]] PlyHeader read_ply_header(const MeshInput& input);

}  // namespace mc::source
