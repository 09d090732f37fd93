// SPDX-License-Identifier: MIT
#include "source/mesh/gltf_document.hpp"

#include <utility>

#include "base/checked.hpp"

namespace mc::source {

namespace {

using nlohmann::json;

bool fits(const GltfElements& elements, std::uint64_t offset, std::size_t size, std::size_t room) {
  if (elements.n == 0) {
    return true;
  }
  const auto span = base::checked_mul<std::uint64_t>(elements.n - 1, elements.stride);
  const auto last = span ? base::checked_add(*span, offset) : std::nullopt;
  const auto end = last ? base::checked_add<std::uint64_t>(*last, size) : std::nullopt;
  return end && *end <= room;
}

std::size_t component_size(std::uint64_t component) {
  return component == 5121 ? 1 : component == 5123 ? 2 : 4;
}

}  // namespace

std::array<float, 3> GltfElements::vector(std::uint64_t at) const {
  const std::byte* p = first + at * stride;
  return {load<float>(p), load<float>(p + 4), load<float>(p + 8)};
}

std::uint64_t GltfElements::index(std::uint64_t at) const {
  const std::byte* p = first + at * stride;
  switch (component) {
    case 5121:
      return load<std::uint8_t>(p);
    case 5123:
      return load<std::uint16_t>(p);
    default:
      return load<std::uint32_t>(p);
  }
}

GltfDocument::GltfDocument(const MeshInput& input, std::string_view text,
                           std::optional<std::span<const std::byte>> binary)
    : input_(input), json_size_(text.size()), buffers_(input, binary) {
  parse(text);
  check_head();
}

void GltfDocument::fail(const std::string& pointer, const std::string& fault) const {
  throw Error(ErrorKind::input, input_.place, pointer + ": " + fault);
}

void GltfDocument::parse(std::string_view text) {
  try {
    root_ = json::parse(text);
  } catch (const json::parse_error& error) {
    const auto start = static_cast<std::size_t>(text.data() - input_.text().data());
    fault_at_line(input_, start + std::max<std::size_t>(error.byte, 1) - 1,
                  "invalid json: expected the json of a gltf");
  } catch (const json::out_of_range&) {
    throw Error(ErrorKind::input, input_.place, "invalid json: a number is past all doubles");
  }
  if (!root_.is_object()) {
    throw Error(ErrorKind::input, input_.place, "expected a json object, as a gltf is one");
  }
}

const json& GltfDocument::list(const json& object, const char* key,
                               const std::string& pointer) const {
  static const json kEmpty = json::array();
  const auto found = object.find(key);
  if (found == object.end()) {
    return kEmpty;
  }
  if (!found->is_array()) {
    fail(pointer + "/" + key, "expected an array");
  }
  return *found;
}

std::uint64_t GltfDocument::number(const json& object, const char* key, const std::string& pointer,
                                   std::optional<std::uint64_t> otherwise) const {
  const auto found = object.find(key);
  if (found == object.end() && otherwise) {
    return *otherwise;
  }
  if (found == object.end() || !found->is_number_unsigned()) {
    fail(pointer + "/" + key, "expected a whole number");
  }
  return found->get<std::uint64_t>();
}

const json& GltfDocument::item(const char* key, std::uint64_t n) const {
  const json& all = list(root_, key, "");
  if (n >= all.size()) {
    fail(pointer_to(key, n), "is named, but there are " + std::to_string(all.size()));
  }
  if (!all[n].is_object()) {
    fail(pointer_to(key, n), "expected an object");
  }
  return all[n];
}

void GltfDocument::check_head() const {
  const auto asset = root_.find("asset");
  if (asset == root_.end() || !asset->is_object() || !asset->contains("version")) {
    fail("/asset/version", "expected a version, as every gltf has one");
  }
  const json& version = (*asset)["version"];
  if (!version.is_string() || !version.get_ref<const std::string&>().starts_with("2.")) {
    fail("/asset/version", "expected 2.0");
  }
  const json& required = list(root_, "extensionsRequired", "");
  for (std::size_t n = 0; n < required.size(); ++n) {
    const std::string name = required[n].is_string() ? required[n].get<std::string>() : "";
    const bool only_looks = name.starts_with("KHR_materials_") ||
                            name.starts_with("KHR_texture_") || name.starts_with("EXT_texture_") ||
                            name.starts_with("KHR_lights_");
    if (!only_looks) {
      fail(pointer_to("extensionsRequired", n),
           "the file cannot be read without this extension: expected plain gltf 2.0");
    }
  }
}

GltfElements GltfDocument::elements(std::uint64_t accessor_number, const char* type,
                                    std::span<const std::uint64_t> components) {
  const json& accessor = item("accessors", accessor_number);
  const std::string pointer = pointer_to("accessors", accessor_number);
  const auto found = accessor.find("type");
  if (found == accessor.end() || *found != type) {
    fail(pointer + "/type", "expected " + std::string(type));
  }
  GltfElements out;
  out.component = number(accessor, "componentType", pointer);
  if (std::ranges::find(components, out.component) == components.end()) {
    fail(pointer + "/componentType",
         std::to_string(out.component) + " is none of the types expected here");
  }
  if (accessor.contains("sparse") || !accessor.contains("bufferView")) {
    fail(pointer, "sparse and empty accessors are not read: expected a bufferView");
  }
  out.n = number(accessor, "count", pointer);
  const std::size_t size =
      component_size(out.component) * (std::string_view(type) == "VEC3" ? 3 : 1);
  const std::uint64_t view_number = number(accessor, "bufferView", pointer);
  const json& view = item("bufferViews", view_number);
  out.stride = number(view, "byteStride", pointer_to("bufferViews", view_number), size);
  const std::span<const std::byte> bytes = view_bytes(view_number);
  const std::uint64_t offset = number(accessor, "byteOffset", pointer, 0);
  if (out.stride < size || !fits(out, offset, size, bytes.size())) {
    fail(pointer, std::to_string(out.n) + " elements do not fit into the " +
                      std::to_string(bytes.size()) + " bytes of their bufferView");
  }
  out.first = out.n > 0 ? bytes.data() + offset : nullptr;
  return out;
}

std::span<const std::byte> GltfDocument::view_bytes(std::uint64_t view_number) {
  const json& view = item("bufferViews", view_number);
  const std::string pointer = pointer_to("bufferViews", view_number);
  const std::uint64_t buffer_number = number(view, "buffer", pointer);
  const json& buffer = item("buffers", buffer_number);
  const std::string buffer_pointer = pointer_to("buffers", buffer_number);
  const auto uri = buffer.find("uri");
  if (uri != buffer.end() && !uri->is_string()) {
    fail(buffer_pointer + "/uri", "expected a string");
  }
  const std::span<const std::byte> bytes = buffers_.get(
      buffer_number, uri == buffer.end() ? nullptr : &uri->get_ref<const std::string&>(),
      number(buffer, "byteLength", buffer_pointer), buffer_pointer);
  const std::uint64_t offset = number(view, "byteOffset", pointer, 0);
  const std::uint64_t size = number(view, "byteLength", pointer);
  if (offset > bytes.size() || size > bytes.size() - offset) {
    fail(pointer, "reaches past the " + std::to_string(bytes.size()) + " bytes of its buffer");
  }
  return bytes.subspan(offset, size);
}

}  // namespace mc::source
