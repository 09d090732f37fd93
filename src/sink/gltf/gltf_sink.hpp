// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "mc/sink.hpp"

namespace mc::sink {

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
MeshNeeds gltf_needs(const SinkOptions& options, bool f32_moves);
/// Numbers of a type that glTF does not have become floats.
std::size_t gltf_attribute_bytes(const AttributeInfo& attribute, const SinkOptions& options);

inline constexpr SinkFormat kGlbFormat{.name = "glb",
                                       .display = "GLB",
                                       .extensions = "glb",
                                       .package = "libtinygltf-dev",
                                       .built_in = MC_WITH_GLTF != 0,
                                       .open_mesh = open_glb,
                                       .needs = gltf_needs,
                                       .attribute_bytes = gltf_attribute_bytes,
                                       .several_objects = true,
                                       .y_up_metres = true,
                                       .to_memory = true};

inline constexpr SinkFormat kGltfFormat{.name = "gltf",
                                        .display = "glTF",
                                        .extensions = "gltf",
                                        .package = "libtinygltf-dev",
                                        .built_in = MC_WITH_GLTF != 0,
                                        .open_mesh = open_gltf,
                                        .needs = gltf_needs,
                                        .attribute_bytes = gltf_attribute_bytes,
                                        .several_objects = true,
                                        .y_up_metres = true,
                                        .one_file = false};

}  // namespace mc::sink
