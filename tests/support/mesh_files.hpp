// SPDX-License-Identifier: MIT
#pragma once

#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mc/mesh.hpp"

// Small mesh files made in memory, written out by hand rather than by the program's own writers.

namespace mc::test {

/// The bytes of a number, little-endian.
template <class T>
std::string bytes_of(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

/// The bytes of a number, big-endian.
template <class T>
std::string big_endian(T value) {
  const std::string bytes = bytes_of(value);
  return {bytes.rbegin(), bytes.rend()};
}

/// The tetrahedron (0,0,0) (1,0,0) (0,1,0) (0,0,1), wound outward, in double precision.
Mesh tetrahedron();

std::string tetrahedron_ply_text();
std::string tetrahedron_ply_binary(bool big);
std::string tetrahedron_obj();
std::string tetrahedron_stl_text();
std::string tetrahedron_stl_binary();

/// The buffer of the glTF below: four positions, then twelve u16 indices.
std::string tetrahedron_gltf_buffer();
/// `buffer` stands for the buffer's properties beside byteLength (", \"uri\": ..." or nothing),
/// `nodes` for the elements of the array of nodes; the scene is node 0.
std::string tetrahedron_gltf(std::string_view buffer, std::string_view nodes = R"({"mesh": 0})");
/// Chunks with their headers, behind the header of the file.
std::string glb(std::string json, std::string binary);

std::string base64(std::string_view bytes);

/// One small file of each format and variant, by name.
std::vector<std::pair<std::string, std::string>> small_mesh_files();

}  // namespace mc::test
