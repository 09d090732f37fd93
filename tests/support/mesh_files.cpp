// SPDX-License-Identifier: MIT
#include "support/mesh_files.hpp"

#include <array>

namespace mc::test {

Mesh tetrahedron() {
  Mesh mesh;
  mesh.positions_f64 = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

std::string tetrahedron_ply_text() {
  return "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 4\nproperty float x\n"
         "property float y\nproperty float z\nelement face 4\n"
         "property list uchar int vertex_indices\nend_header\n"
         "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
}

std::string tetrahedron_ply_binary(bool big) {
  std::string file = "ply\nformat binary_" + std::string(big ? "big" : "little") +
                     "_endian 1.0\nelement vertex 4\nproperty double x\nproperty float32 y\n"
                     "property short z\nelement face 4\n"
                     "property list uint16 uint vertex_index\nend_header\n";
  const auto number = [&](auto value) { file += big ? big_endian(value) : bytes_of(value); };
  for (const Vec3& p : tetrahedron().positions_f64) {
    number(p[0]);
    number(static_cast<float>(p[1]));
    number(static_cast<std::int16_t>(p[2]));
  }
  for (const auto& t : tetrahedron().triangles) {
    number(std::uint16_t{3});
    for (const std::uint32_t v : t) {
      number(v);
    }
  }
  return file;
}

std::string tetrahedron_obj() {
  return "# by hand\no tetrahedron\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
         "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
}

std::string tetrahedron_stl_text() {
  const Mesh mesh = tetrahedron();
  std::string file = "solid by hand\n";
  for (const auto& t : mesh.triangles) {
    file += "facet normal 0 0 0\n  outer loop\n";
    for (const std::uint32_t v : t) {
      file += "    vertex";
      for (const double x : mesh.positions_f64[v]) {
        file += x == 0 ? " 0" : " 1.0e+00";
      }
      file += "\n";
    }
    file += "  endloop\nendfacet\n";
  }
  return file + "endsolid by hand\n";
}

std::string tetrahedron_stl_binary() {
  const Mesh mesh = tetrahedron();
  std::string file = "solid, although binary";
  file.resize(80, ' ');
  file += bytes_of(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    file += std::string(12, '\0');
    for (const std::uint32_t v : t) {
      for (const double x : mesh.positions_f64[v]) {
        file += bytes_of(static_cast<float>(x));
      }
    }
    file += std::string(2, '\0');
  }
  return file;
}

std::string tetrahedron_gltf_buffer() {
  std::string buffer;
  for (const Vec3& p : tetrahedron().positions_f64) {
    for (const double x : p) {
      buffer += bytes_of(static_cast<float>(x));
    }
  }
  for (const auto& t : tetrahedron().triangles) {
    for (const std::uint32_t v : t) {
      buffer += bytes_of(static_cast<std::uint16_t>(v));
    }
  }
  return buffer;
}

std::string tetrahedron_gltf(std::string_view buffer, std::string_view nodes) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [)" +
         std::string(nodes) + R"(],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
{"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
"buffers": [{"byteLength": 72)" +
         std::string(buffer) + "}]}";
}

std::string glb(std::string json, std::string binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  const auto u32 = [](std::size_t n) { return bytes_of(static_cast<std::uint32_t>(n)); };
  return "glTF" + u32(2) + u32(12 + 8 + json.size() + 8 + binary.size()) + u32(json.size()) +
         "JSON" + json + u32(binary.size()) + std::string("BIN\0", 4) + binary;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t n = 0; n < bytes.size(); n += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (n + k < bytes.size() ? static_cast<unsigned char>(bytes[n + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += n + k > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

std::vector<std::pair<std::string, std::string>> small_mesh_files() {
  const std::string uri = ", \"uri\": \"data:application/octet-stream;base64," +
                          base64(tetrahedron_gltf_buffer()) + "\"";
  return {{"text.ply", tetrahedron_ply_text()},
          {"little.ply", tetrahedron_ply_binary(false)},
          {"big.ply", tetrahedron_ply_binary(true)},
          {"tetrahedron.obj", tetrahedron_obj()},
          {"text.stl", tetrahedron_stl_text()},
          {"binary.stl", tetrahedron_stl_binary()},
          {"tetrahedron.gltf", tetrahedron_gltf(uri)},
          {"tetrahedron.glb", glb(tetrahedron_gltf(""), tetrahedron_gltf_buffer())}};
}

}  // namespace mc::test
