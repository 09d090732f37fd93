// SPDX-License-Identifier: MIT
#include "sink/formats.hpp"
#include "sink/gltf/gltf_sink.hpp"

// What a build without tinygltf knows of glTF too.

namespace mc::sink {

MeshNeeds gltf_needs(const SinkOptions& /*options*/, bool f32_moves) {
  // Of a chunk: vertices with normals, and triangles.
  return {.relative_origin = f32_moves, .formatted = {.vertex_bytes = 24, .triangle_bytes = 12}};
}

#if !MC_WITH_GLTF

std::unique_ptr<MeshSink> open_glb(const std::string& path, const SinkOptions& /*options*/) {
  refuse_absent(kGltfFormat, path);
}

std::unique_ptr<MeshSink> open_gltf(const std::string& path, const SinkOptions& /*options*/) {
  refuse_absent(kGltfFormat, path);
}

#endif

}  // namespace mc::sink
