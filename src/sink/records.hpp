// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "mc/mesh.hpp"

// Chunks to records of bytes and to lines of text, in memory that is used again for the next.

namespace mc::sink {

static_assert(std::endian::native == std::endian::little, "every binary format here is so");

/// Makes room for so many bytes, of which none are kept: memory that moves would be there twice.
inline void make_room(Buffer<std::byte>& to, std::size_t n_bytes) {
  if (to.capacity() < n_bytes) {
    to = Buffer<std::byte>();
    to.reserve(n_bytes);
  }
}

/// Fills `to` with records 0..n-1 of `stride` bytes: encode(i, at) makes one.
template <class Encode>
void make_records(std::size_t n, std::size_t stride, Buffer<std::byte>& to, Encode encode) {
  make_room(to, n * stride);
  to.resize(n * stride);
  std::byte* at = to.data();
  for (std::size_t i = 0; i < n; ++i, at += stride) {
    encode(i, at);
  }
}

/// How long a line can be: as print() may write it, and as it is with numbers that are met.
struct LineBytes {
  std::size_t most, usual;
};

/// Fills `to` with lines 0..n-1: print(i, at) writes one and returns its end.
template <class Print>
void make_lines(std::size_t n, const LineBytes& line, Buffer<std::byte>& to, Print print) {
  constexpr std::size_t kAtOnce = 64;  // lines for which room is made
  make_room(to, n * line.usual + kAtOnce * line.most);
  to.resize(to.capacity());
  std::size_t size = 0;
  for (std::size_t first = 0; first < n; first += kAtOnce) {
    if (to.size() - size < kAtOnce * line.most) {
      to.resize(std::max(size + kAtOnce * line.most, 2 * to.size()));
    }
    char* const begin = reinterpret_cast<char*>(to.data());
    char* at = begin + size;
    for (std::size_t i = first; i < std::min(n, first + kAtOnce); ++i) {
      at = print(i, at);
    }
    size = static_cast<std::size_t>(at - begin);
  }
  to.resize(size);
}

/// Positions (f32 or f64, as they came), normals where there are some, then n_more bytes of zeros
/// for attributes: interleaved records.
inline void make_vertices(const MeshChunk& chunk, std::size_t n_more, Buffer<std::byte>& to) {
  const auto interleave = [&]<class T, std::size_t kNormal>(
                              const Buffer<T>& positions,
                              std::integral_constant<std::size_t, kNormal>) {
    constexpr std::size_t kPosition = 3 * sizeof(T);
    const auto put = [p = positions.data(), n = chunk.normals.data()](std::size_t i,
                                                                      std::byte* at) {
      std::memcpy(at, p + 3 * i, kPosition);
      if constexpr (kNormal != 0) std::memcpy(at + kPosition, n + 3 * i, kNormal);
    };
    if (n_more == 0) return make_records(chunk.n_vertices(), kPosition + kNormal, to, put);
    make_records(chunk.n_vertices(), kPosition + kNormal + n_more, to,
                 [put, n_more](std::size_t i, std::byte* at) {
                   put(i, at);
                   std::memset(at + kPosition + kNormal, 0, n_more);
                 });
  };
  const auto with_normals = [&](const auto& positions) {
    if (chunk.normals.empty()) {
      interleave(positions, std::integral_constant<std::size_t, 0>());
    } else {
      interleave(positions, std::integral_constant<std::size_t, 3 * sizeof(float)>());
    }
  };
  chunk.positions_f64.empty() ? with_normals(chunk.positions) : with_normals(chunk.positions_f64);
}

}  // namespace mc::sink
