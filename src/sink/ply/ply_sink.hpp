// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "mc/sink.hpp"

namespace mc::sink {

/// PLY, binary little endian or ASCII. Errors: output.
std::unique_ptr<MeshSink> open_ply(const std::string& path, const SinkOptions& options);
MeshNeeds ply_needs(const SinkOptions& options, bool f32_moves);
/// 0 for integers of 64 bits, which readers of PLY do not know.
std::size_t ply_attribute_bytes(const AttributeInfo& attribute, const SinkOptions& options);

inline constexpr SinkFormat kPlyFormat{.name = "ply",
                                       .display = "PLY",
                                       .extensions = "ply",
                                       .open_mesh = open_ply,
                                       .needs = ply_needs,
                                       .text = TextForm::optional,
                                       .precision = true,
                                       .attribute_bytes = ply_attribute_bytes};

/// How far the indices of PLY reach.
struct PlyLimits {
  std::uint64_t most_vertices = std::uint64_t{1} << 32U;      ///< of a `uint` index
  std::uint64_t most_int_vertices = std::uint64_t{1} << 31U;  ///< of an `int` index
};
/// The same with less of a reach: what tests want.
std::unique_ptr<MeshSink> open_ply_of(const std::string& path, const SinkOptions& options,
                                      const PlyLimits& limits);

}  // namespace mc::sink
