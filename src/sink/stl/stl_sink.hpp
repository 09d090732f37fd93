// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "mc/sink.hpp"

namespace mc::sink {

/// STL, binary or ASCII. Errors: output.
std::unique_ptr<MeshSink> open_stl(const std::string& path, const SinkOptions& options);
MeshNeeds stl_needs(const SinkOptions& options, bool f32_moves);

inline constexpr SinkFormat kStlFormat{.name = "stl",
                                       .display = "STL",
                                       .extensions = "stl",
                                       .open_mesh = open_stl,
                                       .needs = stl_needs,
                                       .text = TextForm::optional,
                                       .has_normals = false};

/// The same with a count of facets that holds less: what tests want.
std::unique_ptr<MeshSink> open_stl_of(const std::string& path, const SinkOptions& options,
                                      std::uint64_t most_facets);

}  // namespace mc::sink
