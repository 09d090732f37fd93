// SPDX-License-Identifier: MIT
#include "sink/gltf/gltf_parts.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <limits>

#include "mc/base.hpp"
#include "sink/gltf/used_vertices.hpp"

// A part is found by reading triangles until one does not fit, and written by reading them again.

namespace mc::sink {

namespace {

constexpr std::size_t kAtOnce = std::size_t{1} << 16;  // triangles or vertices

using Triangle = std::array<std::uint32_t, 3>;

/// The triangles of an object, block by block.
class Triangles {
 public:
  Triangles(const FileWriter& from, const GltfObject& whole) : from_(from), whole_(whole) {}

  [[nodiscard]] std::uint64_t size() const { return whole_.n_indices / 3; }
  Triangle operator[](std::uint64_t n) {
    if (n < first_ || n >= first_ + block_.size() / 3) load(n);
    const std::uint32_t* at = &block_[static_cast<std::size_t>(3 * (n - first_))];
    return {at[0], at[1], at[2]};
  }

 private:
  void load(std::uint64_t n) {
    first_ = n;
    block_.resize(3 * static_cast<std::size_t>(std::min<std::uint64_t>(kAtOnce, size() - n)));
    const std::uint64_t at = whole_.indices_at + 3 * n * whole_.index_bytes();
    if (whole_.has_short_indices()) {
      Buffer<std::uint16_t> small(block_.size());
      from_.read_flushed(at, std::as_writable_bytes(std::span(small)));
      std::copy(small.begin(), small.end(), block_.begin());
    } else {
      from_.read_flushed(at, std::as_writable_bytes(std::span(block_)));
    }
  }

  const FileWriter& from_;
  const GltfObject& whole_;
  std::uint64_t first_ = 0;
  Buffer<std::uint32_t> block_;
};

/// Adds triangles from `first` on as long as they fit; returns the one after the last.
std::uint64_t fill(Triangles& triangles, std::uint64_t first, const GltfObject& whole,
                   std::uint64_t most_bytes, UsedVertices& used) {
  constexpr std::uint64_t kTriangleBytes = 3 * sizeof(std::uint32_t);
  std::uint64_t end = first;
  for (; end < triangles.size(); ++end) {
    const Triangle ids = triangles[end];
    const auto n_new = static_cast<std::uint64_t>(
        std::count_if(ids.begin(), ids.end(), [&](std::uint32_t id) { return !used.has(id); }));
    const std::uint64_t n_bytes =
        (used.size() + n_new) * whole.vertex_bytes() + (end + 1 - first) * kTriangleBytes;
    if (n_bytes > most_bytes) break;
    for (const std::uint32_t id : ids) used.add(id);
  }
  assert(end > first || first == triangles.size());
  return end;
}

void include(GltfObject& part, const std::byte* vertex) {
  std::array<float, 3> position{};
  std::memcpy(position.data(), vertex, sizeof position);
  for (std::size_t a = 0; a < 3; ++a) {
    part.lo[a] = std::min(part.lo[a], position[a]);
    part.hi[a] = std::max(part.hi[a], position[a]);
  }
}

void write_vertices(const FileWriter& from, const GltfObject& whole, const UsedVertices& used,
                    GltfObject& part, FileWriter& to) {
  const std::uint64_t stride = whole.vertex_bytes();
  Buffer<std::byte> block;
  const std::uint64_t end = std::min(used.end(), whole.n_vertices);
  for (std::uint64_t first = used.begin(); first < end; first += kAtOnce) {
    const std::uint64_t n = std::min<std::uint64_t>(kAtOnce, end - first);
    block.resize(static_cast<std::size_t>(n * stride));
    from.read_flushed(whole.vertices_at + first * stride, block);
    std::size_t kept = 0;
    for (std::uint64_t v = 0; v < n; ++v) {
      if (!used.has(first + v)) continue;
      std::memmove(&block[kept], &block[static_cast<std::size_t>(v * stride)],
                   static_cast<std::size_t>(stride));
      include(part, &block[kept]);
      kept += static_cast<std::size_t>(stride);
    }
    to.append(std::span<const std::byte>(block).first(kept));
  }
}

template <class Index>
void write_indices(Triangles& triangles, std::uint64_t first, std::uint64_t end,
                   const UsedVertices& used, FileWriter& to) {
  for (std::uint64_t n = first; n < end; ++n) {
    std::array<Index, 3> numbers{};
    const Triangle ids = triangles[n];
    std::transform(ids.begin(), ids.end(), numbers.begin(),
                   [&](std::uint32_t id) { return static_cast<Index>(used.number_of(id)); });
    to.append(std::as_bytes(std::span(numbers)));
  }
}

}  // namespace

void cut_into_parts(const FileWriter& from, const GltfObject& whole, std::uint64_t most_bytes,
                    const std::function<FileWriter&()>& open,
                    const std::function<void(const GltfObject&)>& made) {
  Triangles triangles(from, whole);
  UsedVertices used;
  for (std::uint64_t first = 0; first < triangles.size();) {
    used.clear();
    const std::uint64_t end = fill(triangles, first, whole, most_bytes, used);
    used.number();
    GltfObject part = whole;
    part.continues = first > 0;
    part.n_vertices = used.size();
    part.n_indices = 3 * (end - first);
    part.vertices_at = 0;
    part.indices_at = part.n_vertices * part.vertex_bytes();
    part.lo.fill(std::numeric_limits<float>::infinity());
    part.hi.fill(-std::numeric_limits<float>::infinity());
    FileWriter& to = open();
    write_vertices(from, whole, used, part, to);
    if (part.has_short_indices()) {
      write_indices<std::uint16_t>(triangles, first, end, used, to);
    } else {
      write_indices<std::uint32_t>(triangles, first, end, used, to);
    }
    made(part);
    first = end;
  }
}

}  // namespace mc::sink
