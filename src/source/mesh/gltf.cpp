// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "source/mesh/gltf_document.hpp"
#include "source/mesh/gltf_transform.hpp"
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

class GltfReader {
 public:
  GltfReader(const MeshInput& input, std::string_view text,
             std::optional<std::span<const std::byte>> binary)
      : input_(input), document_(input, text, binary) {}

  Mesh read() {
    const json& nodes = document_.list(document_.root(), "nodes", "");
    if (nodes.empty()) {
      for (std::size_t m = 0; m < document_.list(document_.root(), "meshes", "").size(); ++m) {
        add_mesh(m, {});
      }
    } else {
      walk(nodes);
    }
    if (!all_have_normals_) {
      mesh_.normals.clear();
    }
    return std::move(mesh_);
  }

 private:
  // Nodes.

  GltfTransform local_transform(const json& node, const std::string& pointer) const {
    GltfTransform local;
    if (const auto m = document_.numbers<16>(node, "matrix", pointer)) {
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 4; ++c) {
          local.rows[r][c] = (*m)[4 * c + r];
        }
      }
      return local;
    }
    const auto t = document_.numbers<3>(node, "translation", pointer).value_or(Vec3{0, 0, 0});
    const auto s = document_.numbers<3>(node, "scale", pointer).value_or(Vec3{1, 1, 1});
    const auto q = document_.numbers<4>(node, "rotation", pointer);
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
      document_.fail(pointer, "expected the number of a node");
    }
    return value.get<std::uint64_t>();
  }

  /// The nodes of the default scene; without scenes, those that are nobody's child.
  [[nodiscard]] std::vector<std::uint64_t> roots(const json& nodes) const {
    std::vector<std::uint64_t> found;
    if (!document_.list(document_.root(), "scenes", "").empty()) {
      const std::uint64_t scene = document_.number(document_.root(), "scene", "", 0);
      const std::string pointer = GltfDocument::pointer_to("scenes", scene);
      for (const json& node : document_.list(document_.item("scenes", scene), "nodes", pointer)) {
        found.push_back(named_node(node, pointer + "/nodes"));
      }
      return found;
    }
    std::vector<bool> is_child(nodes.size(), false);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const std::string pointer = GltfDocument::pointer_to("nodes", n);
      for (const json& child : document_.list(document_.item("nodes", n), "children", pointer)) {
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
    std::vector<std::pair<std::uint64_t, GltfTransform>> ahead;
    for (const std::uint64_t node : roots(nodes)) {
      ahead.emplace_back(node, GltfTransform{});
    }
    std::ranges::reverse(ahead);
    while (!ahead.empty()) {
      const auto [n, parent] = ahead.back();
      ahead.pop_back();
      const json& node = document_.item("nodes", n);
      const std::string pointer = GltfDocument::pointer_to("nodes", n);
      if (seen[n]) {
        document_.fail(pointer, "has two parents: expected nodes to form trees");
      }
      seen[n] = true;
      const GltfTransform global = parent.after(local_transform(node, pointer));
      if (node.contains("mesh")) {
        add_mesh(document_.number(node, "mesh", pointer), global);
      }
      const json& children = document_.list(node, "children", pointer);
      for (auto child = children.rbegin(); child != children.rend(); ++child) {
        ahead.emplace_back(named_node(*child, pointer + "/children"), global);
      }
    }
  }

  // Meshes.

  /// Vertices already made for one mesh under one node.
  struct Placed {
    std::uint64_t position, normal;  // accessors
    std::uint64_t base, n;
  };

  void add_mesh(std::uint64_t mesh_number, const GltfTransform& transform) {
    const std::string pointer = GltfDocument::pointer_to("meshes", mesh_number);
    const json& primitives =
        document_.list(document_.item("meshes", mesh_number), "primitives", pointer);
    std::map<std::pair<std::uint64_t, std::uint64_t>, Placed> placed;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const std::string at = pointer + "/primitives/" + std::to_string(p);
      const json& primitive = primitives[p];
      expect_growth(kPrimitiveCost);
      if (!primitive.is_object()) {
        document_.fail(at, "expected an object");
      }
      if (const std::uint64_t mode = document_.number(primitive, "mode", at, 4); mode != 4) {
        document_.fail(at + "/mode", std::to_string(mode) + " is not read: expected 4 (triangles)");
      }
      const auto attributes = primitive.find("attributes");
      if (attributes == primitive.end() || !attributes->is_object()) {
        document_.fail(at + "/attributes", "expected an object");
      }
      if (!attributes->contains("POSITION")) {
        continue;  // the format lets it pass: nothing is drawn
      }
      const std::uint64_t position = document_.number(*attributes, "POSITION", at + "/attributes");
      const std::uint64_t normal =
          document_.number(*attributes, "NORMAL", at + "/attributes", kNone);
      auto [found, is_new] = placed.try_emplace({position, normal});
      if (is_new) {
        found->second = place_vertices(position, normal, transform);
      }
      add_triangles(primitive, at, found->second, transform);
    }
  }

  Placed place_vertices(std::uint64_t position, std::uint64_t normal,
                        const GltfTransform& transform) {
    constexpr std::array<std::uint64_t, 1> kFloat = {5126};
    const GltfElements points = document_.elements(position, "VEC3", kFloat);
    const Placed placed{position, normal, mesh_.n_vertices(), points.n};
    expect_growth(points.n);
    add_positions(points, transform);
    all_have_normals_ = all_have_normals_ && (normal != kNone || points.n == 0);
    if (!all_have_normals_ || normal == kNone) {
      return placed;
    }
    const GltfElements normals = document_.elements(normal, "VEC3", kFloat);
    if (normals.n != points.n) {
      document_.fail(
          GltfDocument::pointer_to("accessors", normal),
          std::to_string(normals.n) + " normals for " + std::to_string(points.n) + " positions");
    }
    for (std::uint64_t v = 0; v < normals.n; ++v) {
      mesh_.normals.push_back(transform.normal(normals.vector(v)));
    }
    return placed;
  }

  /// In single precision until a node moves vertices.
  void add_positions(const GltfElements& points, const GltfTransform& transform) {
    if (transform.is_identity() && mesh_.positions_f64.empty()) {
      for (std::uint64_t v = 0; v < points.n; ++v) {
        mesh_.positions.push_back(points.vector(v));
      }
      return;
    }
    for (const auto& p : std::exchange(mesh_.positions, {})) {
      mesh_.positions_f64.push_back({double{p[0]}, double{p[1]}, double{p[2]}});
    }
    for (std::uint64_t v = 0; v < points.n; ++v) {
      const std::array<float, 3> p = points.vector(v);
      mesh_.positions_f64.push_back(transform({double{p[0]}, double{p[1]}, double{p[2]}}));
    }
  }

  void add_triangles(const json& primitive, const std::string& pointer, const Placed& vertices,
                     const GltfTransform& transform) {
    GltfElements corners;
    const bool indexed = primitive.contains("indices");
    if (indexed) {
      constexpr std::array<std::uint64_t, 3> kWhole = {5121, 5123, 5125};
      corners =
          document_.elements(document_.number(primitive, "indices", pointer), "SCALAR", kWhole);
    } else {
      corners.n = vertices.n;
    }
    if (corners.n % 3 != 0) {
      document_.fail(pointer,
                     std::to_string(corners.n) + " corners: expected three for each triangle");
    }
    expect_growth(corners.n);
    const std::size_t second = transform.determinant() < 0 ? 2 : 1;
    for (std::uint64_t c = 0; c < corners.n; c += 3) {
      std::array<std::uint64_t, 3> triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint64_t index = indexed ? corners.index(c + k) : c + k;
        triangle[k] = index < vertices.n ? vertices.base + index : kOutOfRange;
      }
      mesh_.add_triangle({triangle[0], triangle[second], triangle[3 - second]});
    }
  }

  /// Refuses a mesh that repetition blows up past all measure; `n` vertices or corners come next.
  void expect_growth(std::uint64_t n) {
    n_made_ += n;
    if (n_made_ / kMostGrowth > document_.size()) {
      throw Error(ErrorKind::limit, input_.place,
                  "its nodes repeat meshes until they are more than " +
                      std::to_string(kMostGrowth) + " times the size of the file");
    }
  }

  const MeshInput& input_;
  GltfDocument document_;
  Mesh mesh_;
  bool all_have_normals_ = true;
  std::uint64_t n_made_ = 0;
};

}  // namespace

Mesh read_gltf(const MeshInput& input) {
  return GltfReader(input, input.text(), std::nullopt).read();
}

Mesh read_glb(const MeshInput& input) {
  const GlbChunks chunks = split_glb(input);
  return GltfReader(input, chunks.json, chunks.binary).read();
}

}  // namespace mc::source
