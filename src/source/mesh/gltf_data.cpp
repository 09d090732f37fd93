// SPDX-License-Identifier: MIT
#include "source/mesh/gltf_data.hpp"

#include <cctype>
#include <charconv>
#include <filesystem>
#include <system_error>
#include <utility>

// Buffers of a glTF are looked for where the format allows them: in the GLB's second chunk, in a
// data: URI, in a regular file named relative to this one. Nothing else is opened.

namespace mc::source {

namespace {

constexpr std::size_t kGlbHeader = 12;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') {
    return c - 'A';
  }
  if (c >= 'a' && c <= 'z') {
    return c - 'a' + 26;
  }
  if (c >= '0' && c <= '9') {
    return c - '0' + 52;
  }
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Undoes %20 and its like; nothing where a "%" is not followed by two hexadecimal digits.
std::optional<std::string> without_escapes(std::string_view uri) {
  std::string text;
  for (std::size_t n = 0; n < uri.size(); ++n) {
    if (uri[n] != '%') {
      text += uri[n];
      continue;
    }
    unsigned code = 0;
    const std::string_view digits = uri.substr(n + 1, 2);
    const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
    if (digits.size() != 2 || result.ptr != digits.data() + 2) {
      return std::nullopt;
    }
    text += static_cast<char>(code);
    n += 2;
  }
  return text;
}

[[noreturn]] void fault_at(const MeshInput& input, const std::string& pointer,
                           const std::string& fault) {
  throw Error(ErrorKind::input, input.place, pointer + ": " + fault);
}

}  // namespace

GlbChunks split_glb(const MeshInput& input) {
  const std::span<const std::byte> bytes = input.bytes;
  if (bytes.size() < kGlbHeader + 8) {
    fault_at_byte(input, bytes.size(), "the file ends early: expected the header of a glb");
  }
  if (const auto version = load<std::uint32_t>(&bytes[4]); version != 2) {
    fault_at_byte(input, 4, "glb version " + std::to_string(version) + ": expected 2");
  }
  if (const auto length = load<std::uint32_t>(&bytes[8]); length != bytes.size()) {
    fault_at_byte(input, 8,
                  "the header says " + std::to_string(length) + " bytes, but the file has " +
                      std::to_string(bytes.size()),
                  "the file is truncated or damaged");
  }
  GlbChunks chunks;
  for (std::size_t at = kGlbHeader, n = 0; at < bytes.size(); ++n) {
    if (bytes.size() - at < 8) {
      fault_at_byte(input, at, "the file ends early: expected a chunk");
    }
    const std::size_t size = load<std::uint32_t>(&bytes[at]);
    const auto type = load<std::uint32_t>(&bytes[at + 4]);
    if (bytes.size() - at - 8 < size) {
      fault_at_byte(input, at,
                    "a chunk of " + std::to_string(size) + " bytes, but " +
                        std::to_string(bytes.size() - at - 8) + " are left");
    }
    if ((n == 0) != (type == kJsonChunk)) {
      fault_at_byte(input, at + 4, "expected one json chunk, and it first");
    }
    if (n == 0) {
      chunks.json = input.text().substr(at + 8, size);
    } else if (n == 1 && type == kBinaryChunk) {
      chunks.binary = bytes.subspan(at + 8, size);
    }
    at += 8 + size;
  }
  return chunks;
}

std::optional<std::vector<std::byte>> decode_base64(std::string_view text) {
  for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) {
    text.remove_suffix(1);
  }
  std::vector<std::byte> bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int n_bits = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) {
      return std::nullopt;
    }
    bits = (bits << 6 | static_cast<std::uint32_t>(digit)) & 0xFFFFFF;
    n_bits += 6;
    if (n_bits >= 8) {
      n_bits -= 8;
      bytes.push_back(static_cast<std::byte>(bits >> n_bits & 0xFF));
    }
  }
  // Six bits left over are a lone last digit.
  return n_bits == 6 ? std::nullopt : std::optional(std::move(bytes));
}

std::span<const std::byte> GltfBuffers::get(std::size_t number, const std::string* uri,
                                            std::uint64_t size, const std::string& pointer) {
  auto found = known_.find(number);
  if (found == known_.end()) {
    const std::span<const std::byte> bytes = fetch(number, uri, pointer);
    total_size_ += bytes.size();
    found = known_.emplace(number, bytes).first;
  }
  if (found->second.size() < size) {
    fault_at(input_, pointer,
             std::to_string(found->second.size()) + " bytes, but byteLength says " +
                 std::to_string(size));
  }
  return found->second.first(size);
}

std::span<const std::byte> GltfBuffers::fetch(std::size_t number, const std::string* uri,
                                              const std::string& pointer) {
  if (uri == nullptr) {
    if (number != 0 || !binary_) {
      fault_at(input_, pointer, "no uri: expected one, or a binary chunk of a glb");
    }
    return *binary_;
  }
  if (!uri->starts_with("data:")) {
    return open_file(*uri, pointer);
  }
  const std::string_view text = *uri;
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || !text.substr(0, comma).ends_with(";base64")) {
    fault_at(input_, pointer, "a data uri that is not base64: expected data:...;base64,...");
  }
  std::optional<std::vector<std::byte>> bytes = decode_base64(text.substr(comma + 1));
  if (!bytes) {
    fault_at(input_, pointer, "damaged base64 in its data uri");
  }
  return decoded_[number] = std::move(*bytes);
}

std::span<const std::byte> GltfBuffers::open_file(const std::string& uri,
                                                  const std::string& pointer) {
  const std::optional<std::string> name = without_escapes(uri);
  const bool usable = name && !name->empty() && name->find('\0') == std::string::npos &&
                      name->find(':') == std::string::npos && name->front() != '/';
  if (!usable) {
    fault_at(input_, pointer, "expected the uri of a file beside this one, or data:");
  }
  if (!input_.folder) {
    fault_at(input_, pointer, "names a file, and a stream has none beside it");
  }
  const std::string path = (*input_.folder / *name).string();
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored)) {
    throw Error(ErrorKind::input, path, "is no regular file, as a buffer of a gltf must be");
  }
  return files_.try_emplace(path, InputFile(path, InputFile::Bytes::stored)).first->second.bytes();
}

}  // namespace mc::source
