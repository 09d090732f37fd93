// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>

#include "mc/sink.hpp"

namespace mc::sink {

/// What is made of a chunk's vertices, with normals, and triangles.
inline constexpr Formatted kGltfFormatted{.vertex_bytes = 24, .triangle_bytes = 12};

/// glTF 2.0 in one binary file. Errors: output.
std::unique_ptr<MeshSink> open_glb(const std::string& path, const SinkOptions& options);
/// glTF 2.0 as JSON beside a .bin of the same name. Errors: output; usage, when `path` is a stream.
std::unique_ptr<MeshSink> open_gltf(const std::string& path, const SinkOptions& options);

}  // namespace mc::sink
