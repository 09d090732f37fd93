// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>

#include "mc/mesh.hpp"
#include "source/mesh/mesh_input.hpp"

// What the mesh fuzzer runs, shared with the tests that replay the corpus.

namespace mc::test {

/// Reads the bytes as a mesh by their content, then as each format that only an extension decides,
/// and checks what was read. True: the content alone was readable. Anything but an Error of kind
/// input or limit comes out.
inline bool read_and_check_mesh(std::span<const std::byte> bytes) {
  bool readable = false;
  for (const char* const extension : {"", ".obj", ".stl", ".gltf"}) {
    try {
      const MeshReport report = check_mesh(
          source::parse_mesh({.bytes = bytes, .place = "fuzz", .folder = {}}, extension));
      readable = readable || (*extension == '\0' && report.components <= report.n_vertices);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::input && error.kind() != ErrorKind::limit) {
        throw;
      }
    }
  }
  return readable;
}

}  // namespace mc::test
