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

/// Makes room for n elements, of which none are kept: memory that moves would be there twice.
template <class T>
void make_room(Buffer<T>& to, std::size_t n) {
  if (to.capacity() < n) {
    to = Buffer<T>();
    to.reserve(n);
  }
}

/// Bytes of a block of records: small enough for the second-level cache, beside what it is made of.
constexpr std::size_t kBlockBytes = std::size_t{1} << 18;
/// Bytes behind the last record that encoding may overwrite.
constexpr std::size_t kRecordSlack = 8;

/// Fills `to` with records [first, last) of `stride` bytes: encode(first, last, at) makes them from
/// `at` on.
template <class Encode>
void make_records(std::size_t first, std::size_t last, std::size_t stride, Buffer<std::byte>& to,
                  Encode encode) {
  const std::size_t n_bytes = (last - first) * stride;
  make_room(to, std::max(n_bytes, kBlockBytes) + kRecordSlack);
  to.resize(n_bytes);
  encode(first, last, to.data());
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

/// Positions (f32 or f64, as they came), normals if there are some, then n_more bytes of zeros for
/// attributes: interleaved records of vertices [first, last).
inline void put_vertices(const MeshChunk& chunk, std::size_t first, std::size_t last,
                         std::size_t n_more, std::byte* at) {
  const auto interleave = [&]<class T, std::size_t kNormal>(
                              const Buffer<T>& positions,
                              std::integral_constant<std::size_t, kNormal>) {
    constexpr std::size_t kPosition = 3 * sizeof(T);
    const T* p = positions.data();
    const float* n = chunk.normals.data();
    for (std::size_t v = first; v < last; ++v) {
      std::memcpy(at, p + 3 * v, kPosition);
      if constexpr (kNormal != 0) std::memcpy(at + kPosition, n + 3 * v, kNormal);
      at += kPosition + kNormal;
      if (n_more == 0) continue;
      std::memset(at, 0, n_more);
      at += n_more;
    }
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

/// Makes records of one index each: the index and `base`, which fit the type together.
template <class Index>
auto id_encoder(const MeshChunk& chunk, std::uint32_t base) {
  return [&chunk, base](std::size_t first, std::size_t last, std::byte* at) {
    const std::uint32_t* index = chunk.indices.data();
    for (std::size_t n = first; n < last; ++n, at += sizeof(Index)) {
      const auto id = static_cast<Index>(base + index[n]);
      std::memcpy(at, &id, sizeof id);
    }
  };
}
/// The same with ids of the whole mesh.
template <class Index>
auto id_encoder(const MeshChunk& chunk) {
  return id_encoder<Index>(chunk, static_cast<std::uint32_t>(chunk.index_base));
}

}  // namespace mc::sink
