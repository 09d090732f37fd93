// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "mc/mesh.hpp"

// What every mesh reader is given, how it names a place in it, and the readers themselves. A reader
// holds no view of its input after it returns, and trusts no count in it: memory grows only with
// bytes that are there.

namespace mc::source {

struct MeshInput {
  std::span<const std::byte> bytes;
  std::string place;  ///< how messages name it
  /// Where files that it names are looked for; nothing: there are none (a stream).
  std::optional<std::filesystem::path> folder;

  [[nodiscard]] std::string_view text() const {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
};

/// Throws Error(input, "PLACE @ byte N", ...).
[[noreturn]] void fault_at_byte(const MeshInput& input, std::size_t offset, std::string_view fault,
                                std::string_view remedy = {});

/// Throws Error(input, "PLACE:LINE", ...); the line is that of the byte at `offset`.
[[noreturn]] void fault_at_line(const MeshInput& input, std::size_t offset, std::string_view fault,
                                std::string_view remedy = {});

/// A number as the file stores it. Precondition: sizeof(T) bytes are there.
template <class T>
T load(const std::byte* at, std::endian order = std::endian::little) {
  std::byte raw[sizeof(T)];
  for (std::size_t n = 0; n < sizeof(T); ++n) {
    raw[n] = at[order == std::endian::native ? n : sizeof(T) - 1 - n];
  }
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return value;
}

/// Cuts the triangles (first, a, b), (first, b, c), ... from corners that come one by one.
class Fan {
 public:
  explicit Fan(Mesh& mesh) : mesh_(mesh) {}
  void add(std::uint64_t vertex) {
    if (n_corners_ >= 2) {
      mesh_.add_triangle({first_, last_, vertex});
    } else if (n_corners_ == 0) {
      first_ = vertex;
    }
    last_ = vertex;
    ++n_corners_;
  }
  [[nodiscard]] std::size_t n_corners() const { return n_corners_; }

 private:
  Mesh& mesh_;
  std::uint64_t first_ = 0, last_ = 0;
  std::size_t n_corners_ = 0;
};

Mesh read_ply(const MeshInput& input);
Mesh read_obj(const MeshInput& input);
Mesh read_stl_ascii(const MeshInput& input);
Mesh read_stl_binary(const MeshInput& input);
Mesh read_gltf(const MeshInput& input);  ///< JSON text
Mesh read_glb(const MeshInput& input);

/// Whether the size is what the triangle count of a binary STL asks for.
bool has_stl_size(std::span<const std::byte> bytes);

/// Reads a mesh from memory. `extension` (".stl", lower case, may be empty) decides only where the
/// content does not.
Mesh parse_mesh(const MeshInput& input, std::string_view extension);

}  // namespace mc::source
