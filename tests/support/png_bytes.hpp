// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

// PNG files made by hand, without a library: rows are stored, not compressed.

namespace mc::test {

inline std::string big_endian(std::uint32_t v) {
  return {static_cast<char>(v >> 24), static_cast<char>(v >> 16), static_cast<char>(v >> 8),
          static_cast<char>(v)};
}

inline std::string png_chunk(const std::string& type, const std::string& data) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char c : type + data) {
    crc ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320U : 0);
  }
  return big_endian(static_cast<std::uint32_t>(data.size())) + type + data + big_endian(~crc);
}

/// A zlib stream of one stored block: at most 65535 bytes.
inline std::string stored(const std::string& bytes) {
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (const char c : bytes) {
    a = (a + static_cast<std::uint8_t>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const auto n = static_cast<std::uint32_t>(bytes.size());
  const auto low = [](std::uint32_t v) { return static_cast<char>(v); };
  const std::string head{'\x78', '\x01', '\x01', low(n), low(n >> 8), low(~n), low(~n >> 8)};
  return head + bytes + big_endian((b << 16) | a);
}

/// PNG's numbers for what a pixel holds.
enum class PngColour : char { grey = 0, rgb = 2, palette = 3, grey_alpha = 4, rgba = 6 };

/// `rows`: all rows as PNG packs them, 16-bit numbers big-endian, without filter bytes.
inline std::string png_bytes(std::uint32_t width, std::uint32_t height, int depth, PngColour colour,
                             std::string_view rows, const std::string& palette = {}) {
  const std::size_t row = rows.size() / height;
  std::string filtered;
  for (std::size_t r = 0; r < height; ++r)
    filtered += '\0' + std::string(rows.substr(r * row, row));
  const std::string header = big_endian(width) + big_endian(height) + static_cast<char>(depth) +
                             static_cast<char>(colour) + std::string(3, '\0');
  return "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header) +
         (palette.empty() ? "" : png_chunk("PLTE", palette)) + png_chunk("IDAT", stored(filtered)) +
         png_chunk("IEND", "");
}

}  // namespace mc::test
