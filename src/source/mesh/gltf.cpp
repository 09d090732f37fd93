// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/checked.hpp"
#include "source/mesh/gltf_data.hpp"
#include "source/mesh/mesh_input.hpp"

// glTF 2.0, as much of it as triangles need: the nodes of the default scene with their transforms
// applied in double precision, POSITION, NORMAL and indices of every triangle primitive.
// Primitives of one mesh that share their accessors share their vertices. A mirroring transform
// turns the winding, as the format demands. Skins, morph targets and materials are passed over;
// a required extension that could change the geometry is refused.

namespace mc::source {

namespace {

using nlohmann::json;

constexpr std::uint64_t kOutOfRange = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kNone = kOutOfRange;

/// Nodes may repeat a mesh, so a small file may stand for a large one. It is refused when it grows
/// past this many times the bytes it is made of.
constexpr std::uint64_t kMostGrowth = 256;
constexpr std::uint64_t kPrimitiveCost = 256;  // vertices; bounds the time that empty ones take

/// Row by row, the last column is the translation.
struct Transform {
  std::array<std::array<double, 4>, 3> rows{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  [[nodiscard]] Vec3 operator()(const Vec3& p) const {
    Vec3 q{};
    for (std::size_t r = 0; r < 3; ++r) {
      q[r] = rows[r][0] * p[0] + rows[r][1] * p[1] + rows[r][2] * p[2] + rows[r][3];
    }
    return q;
  }

  [[nodiscard]] Transform after(const Transform& first) const {
    Transform both;
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 4; ++c) {
        both.rows[r][c] = rows[r][0] * first.rows[0][c] + rows[r][1] * first.rows[1][c] +
                          rows[r][2] * first.rows[2][c] + (c == 3 ? rows[r][3] : 0);
      }
    }
    return both;
  }

  /// Cofactors of the linear part: determinant times the inverse's transpose.
  [[nodiscard]] std::array<Vec3, 3> cofactors() const {
    std::array<Vec3, 3> c{};
    for (std::size_t r = 0; r < 3; ++r) {
      const auto& a = rows[(r + 1) % 3];
      const auto& b = rows[(r + 2) % 3];
      for (std::size_t k = 0; k < 3; ++k) {
        c[r][k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
      }
    }
    return c;
  }

  [[nodiscard]] bool only_moves() const {
    const Transform identity;
    return std::ranges::equal(rows, identity.rows, [](const auto& a, const auto& b) {
      return std::equal(a.begin(), a.begin() + 3, b.begin());
    });
  }
};

/// Elements of an accessor, checked to lie within its buffer.
struct Elements {
  const std::byte* first = nullptr;
  std::size_t stride = 0;
  std::uint64_t n = 0;
  std::uint64_t component = 0;  // glTF's number of the type
};

class GltfReader {
 public:
  GltfReader(const MeshInput& input, std::string_view text,
             std::optional<std::span<const std::byte>> binary)
      : input_(input), json_size_(text.size()), buffers_(input, binary) {
    parse(text);
  }

  MeshSoup read() {
    check_head();
    const json& nodes = list(root_, "nodes", "");
    if (nodes.empty()) {
      for (std::size_t m = 0; m < list(root_, "meshes", "").size(); ++m) {
        add_mesh(m, {});
      }
    } else {
      walk(nodes);
    }
    if (!all_have_normals_) {
      soup_.normals.clear();
    }
    return std::move(soup_);
  }

 private:
  // Looking things up. `pointer` is the JSON Pointer of `object`, for messages.

  [[noreturn]] void fail(const std::string& pointer, const std::string& fault) const {
    throw Error(ErrorKind::input, input_.place, pointer + ": " + fault);
  }

  void parse(std::string_view text) {
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

  [[nodiscard]] const json& list(const json& object, const char* key,
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

  [[nodiscard]] std::uint64_t number(const json& object, const char* key,
                                     const std::string& pointer,
                                     std::optional<std::uint64_t> otherwise = {}) const {
    const auto found = object.find(key);
    if (found == object.end() && otherwise) {
      return *otherwise;
    }
    if (found == object.end() || !found->is_number_unsigned()) {
      fail(pointer + "/" + key, "expected a whole number");
    }
    return found->get<std::uint64_t>();
  }

  /// Element `n` of a list at the root, which must be an object.
  [[nodiscard]] const json& item(const char* key, std::uint64_t n) const {
    const json& all = list(root_, key, "");
    if (n >= all.size()) {
      fail(pointer_to(key, n), "is named, but there are " + std::to_string(all.size()));
    }
    if (!all[n].is_object()) {
      fail(pointer_to(key, n), "expected an object");
    }
    return all[n];
  }

  static std::string pointer_to(const char* key, std::uint64_t n) {
    return "/" + std::string(key) + "/" + std::to_string(n);
  }

  /// N numbers under `key`, or nothing.
  template <std::size_t N>
  [[nodiscard]] std::optional<std::array<double, N>> numbers(const json& object, const char* key,
                                                             const std::string& pointer) const {
    const auto found = object.find(key);
    if (found == object.end()) {
      return std::nullopt;
    }
    const auto is_number = [](const json& value) { return value.is_number(); };
    if (!found->is_array() || found->size() != N || !std::ranges::all_of(*found, is_number)) {
      fail(pointer + "/" + key, "expected " + std::to_string(N) + " numbers");
    }
    std::array<double, N> values{};
    for (std::size_t n = 0; n < N; ++n) {
      values[n] = (*found)[n].template get<double>();
    }
    return values;
  }

  void check_head() const {
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
                              name.starts_with("KHR_texture_") ||
                              name.starts_with("EXT_texture_") || name.starts_with("KHR_lights_");
      if (!only_looks) {
        fail(pointer_to("extensionsRequired", n),
             "the file cannot be read without this extension: expected plain gltf 2.0");
      }
    }
  }

  // Nodes.

  Transform local_transform(const json& node, const std::string& pointer) const {
    Transform local;
    if (const auto m = numbers<16>(node, "matrix", pointer)) {
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 4; ++c) {
          local.rows[r][c] = (*m)[4 * c + r];
        }
      }
      return local;
    }
    const auto t = numbers<3>(node, "translation", pointer).value_or(Vec3{0, 0, 0});
    const auto s = numbers<3>(node, "scale", pointer).value_or(Vec3{1, 1, 1});
    const auto q = numbers<4>(node, "rotation", pointer);
    if (q) {
      const auto [x, y, z, w] = *q;
      local.rows = {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0},
                     {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0},
                     {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0}}};
    }
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) {
        local.rows[r][c] *= s[c];
      }
      local.rows[r][3] = t[r];
    }
    return local;
  }

  [[nodiscard]] std::uint64_t named_node(const json& value, const std::string& pointer) const {
    if (!value.is_number_unsigned()) {
      fail(pointer, "expected the number of a node");
    }
    return value.get<std::uint64_t>();
  }

  /// The nodes of the default scene; without scenes, those that are nobody's child.
  [[nodiscard]] std::vector<std::uint64_t> roots(const json& nodes) const {
    std::vector<std::uint64_t> found;
    if (!list(root_, "scenes", "").empty()) {
      const std::uint64_t scene = number(root_, "scene", "", 0);
      const std::string pointer = pointer_to("scenes", scene);
      for (const json& node : list(item("scenes", scene), "nodes", pointer)) {
        found.push_back(named_node(node, pointer + "/nodes"));
      }
      return found;
    }
    std::vector<bool> is_child(nodes.size(), false);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const std::string pointer = pointer_to("nodes", n);
      for (const json& child : list(item("nodes", n), "children", pointer)) {
        const std::uint64_t number = named_node(child, pointer + "/children");
        if (number < nodes.size()) {
          is_child[number] = true;
        }
      }
    }
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (!is_child[n]) {
        found.push_back(n);
      }
    }
    return found;
  }

  void walk(const json& nodes) {
    std::vector<bool> seen(nodes.size(), false);
    std::vector<std::pair<std::uint64_t, Transform>> ahead;
    for (const std::uint64_t node : roots(nodes)) {
      ahead.emplace_back(node, Transform{});
    }
    std::ranges::reverse(ahead);
    while (!ahead.empty()) {
      const auto [n, parent] = ahead.back();
      ahead.pop_back();
      const json& node = item("nodes", n);
      const std::string pointer = pointer_to("nodes", n);
      if (seen[n]) {
        fail(pointer, "has two parents: expected nodes to form trees");
      }
      seen[n] = true;
      const Transform global = parent.after(local_transform(node, pointer));
      if (node.contains("mesh")) {
        add_mesh(number(node, "mesh", pointer), global);
      }
      const json& children = list(node, "children", pointer);
      for (auto child = children.rbegin(); child != children.rend(); ++child) {
        ahead.emplace_back(named_node(*child, pointer + "/children"), global);
      }
    }
  }

  // Accessors.

  Elements elements(std::uint64_t accessor_number, const char* type,
                    std::span<const std::uint64_t> components) {
    const json& accessor = item("accessors", accessor_number);
    const std::string pointer = pointer_to("accessors", accessor_number);
    const auto found = accessor.find("type");
    if (found == accessor.end() || *found != type) {
      fail(pointer + "/type", "expected " + std::string(type));
    }
    Elements out;
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

  static bool fits(const Elements& elements, std::uint64_t offset, std::size_t size,
                   std::size_t room) {
    if (elements.n == 0) {
      return true;
    }
    const auto span = base::checked_mul<std::uint64_t>(elements.n - 1, elements.stride);
    const auto last = span ? base::checked_add(*span, offset) : std::nullopt;
    const auto end = last ? base::checked_add<std::uint64_t>(*last, size) : std::nullopt;
    return end && *end <= room;
  }

  static std::size_t component_size(std::uint64_t component) {
    return component == 5121 ? 1 : component == 5123 ? 2 : 4;
  }

  std::span<const std::byte> view_bytes(std::uint64_t view_number) {
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

  // Meshes.

  /// Vertices already made for one mesh under one node.
  struct Placed {
    std::uint64_t position, normal;  // accessors
    std::uint64_t base, n;
  };

  void add_mesh(std::uint64_t mesh_number, const Transform& transform) {
    const std::string pointer = pointer_to("meshes", mesh_number);
    const json& primitives = list(item("meshes", mesh_number), "primitives", pointer);
    std::map<std::pair<std::uint64_t, std::uint64_t>, Placed> placed;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const std::string at = pointer + "/primitives/" + std::to_string(p);
      const json& primitive = primitives[p];
      expect_growth(kPrimitiveCost);
      if (!primitive.is_object()) {
        fail(at, "expected an object");
      }
      if (const std::uint64_t mode = number(primitive, "mode", at, 4); mode != 4) {
        fail(at + "/mode", std::to_string(mode) + " is not read: expected 4 (triangles)");
      }
      const auto attributes = primitive.find("attributes");
      if (attributes == primitive.end() || !attributes->is_object()) {
        fail(at + "/attributes", "expected an object");
      }
      if (!attributes->contains("POSITION")) {
        continue;  // the format lets it pass: nothing is drawn
      }
      const std::uint64_t position = number(*attributes, "POSITION", at + "/attributes");
      const std::uint64_t normal = number(*attributes, "NORMAL", at + "/attributes", kNone);
      auto [found, is_new] = placed.try_emplace({position, normal});
      if (is_new) {
        found->second = place_vertices(position, normal, transform);
      }
      add_triangles(primitive, at, found->second, transform);
    }
  }

  Placed place_vertices(std::uint64_t position, std::uint64_t normal, const Transform& transform) {
    constexpr std::array<std::uint64_t, 1> kFloat = {5126};
    const Elements points = elements(position, "VEC3", kFloat);
    const Placed placed{position, normal, soup_.positions.size(), points.n};
    expect_growth(points.n);
    for (std::uint64_t v = 0; v < points.n; ++v) {
      const std::array<float, 3> p = vector_at(points, v);
      soup_.positions.push_back(transform({double{p[0]}, double{p[1]}, double{p[2]}}));
    }
    all_have_normals_ = all_have_normals_ && (normal != kNone || points.n == 0);
    if (!all_have_normals_ || normal == kNone) {
      return placed;
    }
    const Elements normals = elements(normal, "VEC3", kFloat);
    if (normals.n != points.n) {
      fail(pointer_to("accessors", normal),
           std::to_string(normals.n) + " normals for " + std::to_string(points.n) + " positions");
    }
    for (std::uint64_t v = 0; v < normals.n; ++v) {
      soup_.normals.push_back(transformed_normal(vector_at(normals, v), transform));
    }
    return placed;
  }

  static std::array<float, 3> vector_at(const Elements& elements, std::uint64_t n) {
    const std::byte* at = elements.first + n * elements.stride;
    return {load<float>(at), load<float>(at + 4), load<float>(at + 8)};
  }

  static double determinant(const Transform& transform) {
    const Vec3 c = transform.cofactors()[0];
    return transform.rows[0][0] * c[0] + transform.rows[0][1] * c[1] + transform.rows[0][2] * c[2];
  }

  static std::array<float, 3> transformed_normal(const std::array<float, 3>& normal,
                                                 const Transform& transform) {
    if (transform.only_moves()) {
      return normal;
    }
    const std::array<Vec3, 3> cofactors = transform.cofactors();
    const double sign = determinant(transform) < 0 ? -1 : 1;
    Vec3 turned{};
    for (std::size_t r = 0; r < 3; ++r) {
      turned[r] =
          sign * (cofactors[r][0] * double{normal[0]} + cofactors[r][1] * double{normal[1]} +
                  cofactors[r][2] * double{normal[2]});
    }
    const double length = std::hypot(turned[0], turned[1], turned[2]);
    const double scale = length > 0 ? 1 / length : 1;
    return {static_cast<float>(turned[0] * scale), static_cast<float>(turned[1] * scale),
            static_cast<float>(turned[2] * scale)};
  }

  void add_triangles(const json& primitive, const std::string& pointer, const Placed& vertices,
                     const Transform& transform) {
    Elements corners;
    const bool indexed = primitive.contains("indices");
    if (indexed) {
      constexpr std::array<std::uint64_t, 3> kWhole = {5121, 5123, 5125};
      corners = elements(number(primitive, "indices", pointer), "SCALAR", kWhole);
    } else {
      corners.n = vertices.n;
    }
    if (corners.n % 3 != 0) {
      fail(pointer, std::to_string(corners.n) + " corners: expected three for each triangle");
    }
    expect_growth(corners.n);
    const std::size_t second = determinant(transform) < 0 ? 2 : 1;
    for (std::uint64_t c = 0; c < corners.n; c += 3) {
      std::array<std::uint64_t, 3> triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint64_t index = indexed ? index_at(corners, c + k) : c + k;
        triangle[k] = index < vertices.n ? vertices.base + index : kOutOfRange;
      }
      soup_.triangles.push_back({triangle[0], triangle[second], triangle[3 - second]});
    }
  }

  static std::uint64_t index_at(const Elements& elements, std::uint64_t n) {
    const std::byte* at = elements.first + n * elements.stride;
    switch (elements.component) {
      case 5121:
        return load<std::uint8_t>(at);
      case 5123:
        return load<std::uint16_t>(at);
      default:
        return load<std::uint32_t>(at);
    }
  }

  /// Refuses a mesh that repetition blows up past all measure; `n` vertices or corners come next.
  void expect_growth(std::uint64_t n) {
    n_made_ += n;
    if (n_made_ / kMostGrowth > json_size_ + buffers_.total_size()) {
      throw Error(ErrorKind::limit, input_.place,
                  "its nodes repeat meshes until they are more than " +
                      std::to_string(kMostGrowth) + " times the size of the file");
    }
  }

  const MeshInput& input_;
  std::uint64_t json_size_;
  GltfBuffers buffers_;
  json root_;
  MeshSoup soup_;
  bool all_have_normals_ = true;
  std::uint64_t n_made_ = 0;
};

}  // namespace

MeshSoup read_gltf(const MeshInput& input) {
  return GltfReader(input, input.text(), std::nullopt).read();
}

MeshSoup read_glb(const MeshInput& input) {
  const GlbChunks chunks = split_glb(input);
  return GltfReader(input, chunks.json, chunks.binary).read();
}

}  // namespace mc::source
