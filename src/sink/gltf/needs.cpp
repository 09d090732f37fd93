// SPDX-License-Identifier: MIT
#include "sink/formats.hpp"
#include "sink/gltf/gltf_json.hpp"
#include "sink/gltf/gltf_sink.hpp"

// What a build without tinygltf knows of glTF too.

namespace mc::sink {

MeshNeeds gltf_needs(const SinkOptions& /*options*/, bool f32_moves) {
  // Of a chunk: vertices with normals, and triangles.
  return {.relative_origin = f32_moves, .formatted = {.vertex_bytes = 24, .triangle_bytes = 12}};
}

bool becomes_float(SampleType type) {
  return type == SampleType::u32 || type == SampleType::i32 || type == SampleType::i64 ||
         type == SampleType::f16 || type == SampleType::f64;
}

std::size_t attribute_bytes(const AttributeInfo& attribute) {
  if (attribute == material_attribute()) return kColourAt + 4;
  const std::size_t each = becomes_float(attribute.type) ? 4 : sample_size(attribute.type);
  return (attribute.n_components * each + 3) / 4 * 4;
}

std::size_t gltf_attribute_bytes(const AttributeInfo& attribute, const SinkOptions& /*options*/) {
  return attribute_bytes(attribute);
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
