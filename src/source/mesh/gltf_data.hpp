// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "source/mapped_file.hpp"
#include "source/mesh/mesh_input.hpp"

// The bytes behind a glTF: the chunks of a GLB, buffers inside and outside of the file.

namespace mc::source {

/// A GLB taken apart.
struct GlbChunks {
  std::string_view json;
  std::optional<std::span<const std::byte>> binary;
};

/// Errors: input (another version, a length that is not the file's, chunks that do not fit).
GlbChunks split_glb(const MeshInput& input);

/// Decodes base64 with or without its padding; nothing if it holds anything else.
std::optional<std::vector<std::byte>> decode_base64(std::string_view text);

/// Buffers by number, fetched when first asked for.
class GltfBuffers {
 public:
  GltfBuffers(const MeshInput& input, std::optional<std::span<const std::byte>> binary)
      : input_(input), binary_(binary) {}

  /// The first `size` bytes of buffer `number`, whose "uri" is given where it has one. `pointer`
  /// says in messages where it stands.
  std::span<const std::byte> get(std::size_t number, const std::string* uri, std::uint64_t size,
                                 const std::string& pointer);

  /// Bytes of all that was fetched.
  [[nodiscard]] std::uint64_t total_size() const { return total_size_; }

 private:
  std::span<const std::byte> fetch(std::size_t number, const std::string* uri,
                                   const std::string& pointer);
  std::span<const std::byte> open_file(const std::string& uri, const std::string& pointer);

  const MeshInput& input_;
  std::optional<std::span<const std::byte>> binary_;
  std::map<std::size_t, std::span<const std::byte>> known_;
  std::map<std::size_t, std::vector<std::byte>> decoded_;
  std::map<std::string, MappedFile> files_;
  std::uint64_t total_size_ = 0;
};

}  // namespace mc::source
