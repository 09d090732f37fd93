// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "source/mesh/gltf_data.hpp"
#include "source/mesh/mesh_input.hpp"

// The JSON of a glTF and the numbers that its accessors name, each looked up with its checks.
// `pointer` is the JSON Pointer of what is looked into, for messages.

namespace mc::source {

/// Elements of an accessor, checked to lie within its buffer.
struct GltfElements {
  const std::byte* first = nullptr;
  std::size_t stride = 0;
  std::uint64_t n = 0;
  std::uint64_t component = 0;  // glTF's number of the type

  [[nodiscard]] std::array<float, 3> vector(std::uint64_t at) const;
  [[nodiscard]] std::uint64_t index(std::uint64_t at) const;
};

class GltfDocument {
 public:
  using json = nlohmann::json;

  /// Errors   input: no glTF 2.0, or one that needs extensions.
  GltfDocument(const MeshInput& input, std::string_view text,
               std::optional<std::span<const std::byte>> binary);

  [[nodiscard]] const json& root() const { return root_; }
  [[noreturn]] void fail(const std::string& pointer, const std::string& fault) const;
  static std::string pointer_to(const char* key, std::uint64_t n) {
    return "/" + std::string(key) + "/" + std::to_string(n);
  }

  /// An array under `key`, empty if there is none.
  [[nodiscard]] const json& list(const json& object, const char* key,
                                 const std::string& pointer) const;
  [[nodiscard]] std::uint64_t number(const json& object, const char* key,
                                     const std::string& pointer,
                                     std::optional<std::uint64_t> otherwise = {}) const;
  /// Element `n` of a list at the root, which must be an object.
  [[nodiscard]] const json& item(const char* key, std::uint64_t n) const;
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

  /// Those of an accessor, whose component type must be one of the given.
  GltfElements elements(std::uint64_t accessor_number, const char* type,
                        std::span<const std::uint64_t> components);

  /// Bytes of the JSON and of all buffers that were looked into.
  [[nodiscard]] std::uint64_t size() const { return json_size_ + buffers_.total_size(); }

 private:
  void parse(std::string_view text);
  void check_head() const;
  std::span<const std::byte> view_bytes(std::uint64_t view_number);

  const MeshInput& input_;
  std::uint64_t json_size_;
  GltfBuffers buffers_;
  json root_;
};

}  // namespace mc::source
