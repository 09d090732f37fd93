// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "mc/sink.hpp"

namespace mc::sink {

/// What is made of a chunk: positions as floats, ids of the whole mesh.
inline constexpr Formatted kStlFormatted{.vertex_bytes = 12, .triangle_bytes = 12};

/// STL, binary or ASCII. Errors: output.
std::unique_ptr<MeshSink> open_stl(const std::string& path, const SinkOptions& options);
/// The same with a count of facets that holds less: what tests want.
std::unique_ptr<MeshSink> open_stl_of(const std::string& path, const SinkOptions& options,
                                      std::uint64_t most_facets);

}  // namespace mc::sink
