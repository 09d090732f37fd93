// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

// Packed data made by hand, without a library: bytes are stored, not compressed.

namespace mc::test {

inline std::string little_endian(std::uint32_t v) {
  return {static_cast<char>(v), static_cast<char>(v >> 8), static_cast<char>(v >> 16),
          static_cast<char>(v >> 24)};
}

/// One gzip member of one stored block: at most 65535 bytes.
inline std::string gzip_bytes(std::string_view bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : bytes) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320U : 0);
  }
  const auto n = static_cast<std::uint32_t>(bytes.size());
  const std::string head("\x1f\x8b\x08\0\0\0\0\0\0\xff\x01", 11);
  return head + little_endian(n).substr(0, 2) + little_endian(~n).substr(0, 2) +
         std::string(bytes) + little_endian(~crc) + little_endian(n);
}

/// One zstd frame of one raw block, of a content size in 4 bytes: at most 65535 bytes.
inline std::string zstd_bytes(std::string_view bytes) {
  const auto n = static_cast<std::uint32_t>(bytes.size());
  return "\x28\xb5\x2f\xfd\xa0" + little_endian(n) + little_endian(n << 3U | 1U).substr(0, 3) +
         std::string(bytes);
}

}  // namespace mc::test
