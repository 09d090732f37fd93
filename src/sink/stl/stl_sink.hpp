// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "mc/sink.hpp"

namespace mc::sink {

/// What is made of a chunk: positions as floats, ids of the whole mesh.
inline constexpr Formatted kStlFormatted{.vertex_bytes = 12, .triangle_bytes = 12};

/// STL, binary or ASCII. Errors: output.
std::unique_ptr<MeshSink> open_stl(const std::string& path, const SinkOptions& options);

}  // namespace mc::sink
