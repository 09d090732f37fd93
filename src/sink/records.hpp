// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>

#include "mc/mesh.hpp"

// Chunks to records of bytes, block by block: a block is as large as what the file layer passes on
// unbuffered, and no larger, whatever the size of the chunk.

namespace mc::sink {

static_assert(std::endian::native == std::endian::little, "every binary format here is so");

constexpr std::size_t kBlockBytes = std::size_t{1} << 20;

/// Puts records 0..n-1 of `stride` bytes: encode(i, at) fills one, put(block) takes them in order.
template <class Encode, class Put>
void put_records(std::size_t n, std::size_t stride, Buffer<std::byte>& scratch, Encode encode,
                 Put put) {
  const std::size_t per_block = (kBlockBytes + stride - 1) / stride;
  for (std::size_t first = 0; first < n; first += per_block) {
    const std::size_t last = std::min(n, first + per_block);
    scratch.resize((last - first) * stride);
    std::byte* at = scratch.data();
    for (std::size_t i = first; i < last; ++i, at += stride) {
      encode(i, at);
    }
    put(std::span<const std::byte>(scratch));
  }
}

/// The same for lines of text; print(i, text) appends line i.
template <class Print, class Put>
void put_lines(std::size_t n, std::string& scratch, Print print, Put put) {
  scratch.clear();
  for (std::size_t i = 0; i < n; ++i) {
    print(i, scratch);
    if (scratch.size() >= kBlockBytes) {
      put(std::as_bytes(std::span<const char>(scratch)));
      scratch.clear();
    }
  }
  put(std::as_bytes(std::span<const char>(scratch)));
}

/// Positions (f32 or f64, as they came), then the normal where `with_normals`.
inline void encode_vertex(const MeshChunk& chunk, bool with_normals, std::size_t i, std::byte* at) {
  if (chunk.positions_f64.empty()) {
    std::memcpy(at, &chunk.positions[3 * i], 3 * sizeof(float));
    at += 3 * sizeof(float);
  } else {
    std::memcpy(at, &chunk.positions_f64[3 * i], 3 * sizeof(double));
    at += 3 * sizeof(double);
  }
  if (with_normals) {
    std::memcpy(at, &chunk.normals[3 * i], 3 * sizeof(float));
  }
}

}  // namespace mc::sink
