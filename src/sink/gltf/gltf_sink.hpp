// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "mc/sink.hpp"

namespace mc::sink {

/// What is made of a chunk's vertices, with normals, and triangles.
inline constexpr Formatted kGltfFormatted{.vertex_bytes = 24, .triangle_bytes = 12};

/// glTF 2.0 in one binary file. Errors: output.
std::unique_ptr<MeshSink> open_glb(const std::string& path, const SinkOptions& options);
/// The same with a file of at most `most_bytes`: what tests want.
std::unique_ptr<MeshSink> open_glb_of(const std::string& path, const SinkOptions& options,
                                      std::uint64_t most_bytes);
/// glTF 2.0 as JSON beside a .bin of the same name, or several of less than 4 GiB: NAME.bin,
/// NAME-2.bin ... Errors: output; usage, when `path` is a stream.
std::unique_ptr<MeshSink> open_gltf(const std::string& path, const SinkOptions& options);
/// The same with files of at most `most_bytes`, a multiple of 4 and enough for a triangle: what
/// tests want.
std::unique_ptr<MeshSink> open_gltf_of(const std::string& path, const SinkOptions& options,
                                       std::uint64_t most_bytes);

}  // namespace mc::sink
