// SPDX-License-Identifier: MIT
#include "sink/gltf/gltf_json.hpp"

#if MC_WITH_GLTF

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <sstream>

// tinygltf builds and serialises the model around an empty buffer; length and place of the real
// one, names (which may be no UTF-8) and the facts in their order are set in its JSON.

namespace mc::sink {

namespace {

using Json = nlohmann::ordered_json;

/// Text of a file's own making, with what is no UTF-8 replaced.
std::string utf8(const std::string& text) {
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace))
      .get<std::string>();
}

bool is_drawn(const GltfObject& object) { return object.n_indices > 0; }

tinygltf::BufferView view(std::uint64_t at, std::uint64_t n_bytes, std::uint64_t stride,
                          int target) {
  tinygltf::BufferView made;
  made.buffer = 0;
  made.byteOffset = static_cast<std::size_t>(at);
  made.byteLength = static_cast<std::size_t>(n_bytes);
  made.byteStride = static_cast<std::size_t>(stride);
  made.target = target;
  return made;
}

tinygltf::Accessor accessor(int of_view, std::size_t at, std::uint64_t count, int component,
                            int type) {
  tinygltf::Accessor made;
  made.bufferView = of_view;
  made.byteOffset = at;
  made.count = static_cast<std::size_t>(count);
  made.componentType = component;
  made.type = type;
  return made;
}

constexpr const char* kPlain = "plain";
constexpr const char* kColoured = "coloured by vertex";

/// Both of one roughness; colours of vertices are factors of the base colour.
tinygltf::Material material_named(const std::string& name) {
  tinygltf::Material made;
  made.name = name;
  const double grey = name == kPlain ? 0.6 : 1.0;
  made.pbrMetallicRoughness.baseColorFactor = {grey, grey, grey, 1.0};
  made.pbrMetallicRoughness.metallicFactor = 0.0;
  made.pbrMetallicRoughness.roughnessFactor = 0.75;
  return made;
}

/// The material of that name, which is appended where it is not there yet.
int add_material(tinygltf::Model& model, const char* name) {
  auto& all = model.materials;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& m) { return m.name == name; });
  const auto at = found - all.begin();
  if (found == all.end()) all.push_back(material_named(name));
  return static_cast<int>(at);
}

int component_of(SampleType type) {
  switch (type) {
    case SampleType::u8:
      return TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    case SampleType::i8:
      return TINYGLTF_COMPONENT_TYPE_BYTE;
    case SampleType::u16:
      return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    case SampleType::i16:
      return TINYGLTF_COMPONENT_TYPE_SHORT;
    default:
      return TINYGLTF_COMPONENT_TYPE_FLOAT;
  }
}

/// "_HEAT": names of an application's own are in capitals after an underscore.
std::string semantic_of(const AttributeInfo& attribute) {
  std::string name = "_" + attribute.name;
  for (char& c : name) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return name;
}

/// Appends the accessor of an attribute of the vertices.
void add_attribute(tinygltf::Model& model, tinygltf::Primitive& primitive, const std::string& name,
                   const tinygltf::Accessor& values) {
  primitive.attributes[name] = static_cast<int>(model.accessors.size());
  model.accessors.push_back(values);
}

/// Appends the accessors of an object's attributes; returns whether a material gives it colours.
bool add_attributes(tinygltf::Model& model, tinygltf::Primitive& primitive,
                    const GltfObject& object, int of_view) {
  constexpr std::array<int, 4> kTypes{TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3,
                                      TINYGLTF_TYPE_VEC4};
  bool is_coloured = false;
  auto at = static_cast<std::size_t>(object.attributes_at());
  for (const AttributeInfo& attribute : object.attributes) {
    add_attribute(model, primitive, semantic_of(attribute),
                  accessor(of_view, at, object.n_vertices, component_of(attribute.type),
                           kTypes[attribute.n_components - 1U]));
    if (attribute == material_attribute()) {
      tinygltf::Accessor colours =
          accessor(of_view, at + kColourAt, object.n_vertices,
                   TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_TYPE_VEC4);
      colours.normalized = true;
      add_attribute(model, primitive, "COLOR_0", colours);
      is_coloured = true;
    }
    at += attribute_bytes(attribute);
  }
  return is_coloured;
}

/// Appends views, accessors and primitive of one object, or part of one; returns the mesh.
int add_mesh(tinygltf::Model& model, const GltfObject& object) {
  const int views = static_cast<int>(model.bufferViews.size());
  const int accessors = static_cast<int>(model.accessors.size());
  model.bufferViews.push_back(view(object.vertices_at, object.n_vertices * object.vertex_bytes(),
                                   object.vertex_bytes(), TINYGLTF_TARGET_ARRAY_BUFFER));
  model.bufferViews.push_back(view(object.indices_at, object.n_indices * object.index_bytes(), 0,
                                   TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER));
  for (std::size_t n = model.bufferViews.size() - 2; n < model.bufferViews.size(); ++n) {
    model.bufferViews[n].buffer = static_cast<int>(object.buffer);
  }
  tinygltf::Accessor positions =
      accessor(views, 0, object.n_vertices, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3);
  positions.minValues.assign(object.lo.begin(), object.lo.end());
  positions.maxValues.assign(object.hi.begin(), object.hi.end());
  model.accessors.push_back(positions);
  model.accessors.push_back(accessor(views + 1, 0, object.n_indices,
                                     object.has_short_indices()
                                         ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT
                                         : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                                     TINYGLTF_TYPE_SCALAR));
  tinygltf::Primitive primitive;
  primitive.attributes["POSITION"] = accessors;
  primitive.indices = accessors + 1;
  if (object.has_normals) {
    add_attribute(
        model, primitive, "NORMAL",
        accessor(views, 12, object.n_vertices, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3));
  }
  const bool is_coloured = add_attributes(model, primitive, object, views);
  primitive.material = add_material(model, is_coloured ? kColoured : kPlain);
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  if (!object.continues) model.meshes.emplace_back();
  model.meshes.back().primitives.push_back(primitive);
  return static_cast<int>(model.meshes.size()) - 1;
}

tinygltf::Model model_of(std::span<const GltfObject> objects) {
  tinygltf::Model model;
  model.asset.version = "2.0";
  model.asset.generator = "mc";
  model.defaultScene = 0;
  tinygltf::Scene scene;
  for (const GltfObject& object : objects) {
    if (object.continues) {
      add_mesh(model, object);
      continue;
    }
    tinygltf::Node node;
    node.name = object.name.empty() ? "object" : utf8(object.name);  // never a node of nothing
    if (object.origin != Vec3{}) {
      node.translation.assign(object.origin.begin(), object.origin.end());
    }
    if (is_drawn(object)) {
      node.mesh = add_mesh(model, object);
      model.meshes.back().name = node.name;
    }
    scene.nodes.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(node);
  }
  model.scenes.push_back(scene);
  if (!model.meshes.empty()) {
    model.buffers.emplace_back();
  }
  return model;
}

}  // namespace

std::string gltf_json(std::span<const GltfObject> objects, std::span<const GltfBuffer> buffers,
                      std::span<const std::pair<std::string, std::string>> provenance) {
  const GltfObject nothing;  // a scene must have a node
  const tinygltf::Model model =
      model_of(objects.empty() ? std::span<const GltfObject>(&nothing, 1) : objects);
  std::stringstream text;
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, text, false, false);
  Json json = Json::parse(text);
  if (!model.buffers.empty()) {
    Json& made = json["buffers"] = Json::array();
    for (const GltfBuffer& buffer : buffers) {
      made.push_back(Json{{"byteLength", buffer.n_bytes}});
      if (!buffer.uri.empty()) {
        made.back()["uri"] = buffer.uri;
      }
    }
  }
  for (const auto& [key, value] : provenance) {
    json["asset"]["extras"][utf8(key)] = utf8(value);
  }
  return buffers.front().uri.empty() ? json.dump() : json.dump(2) + "\n";
}

}  // namespace mc::sink

#endif
