// SPDX-License-Identifier: MIT
#include "pipe/cube_part.hpp"

#include <algorithm>
#include <bit>

#include "process/vertex_buffers.hpp"

namespace mc::pipe {

namespace {

constexpr std::uint32_t kWordBits = 64;

std::uint64_t bit_of(std::uint32_t vertex) { return std::uint64_t{1} << (vertex % kWordBits); }

}  // namespace

void CubePart::Subset::clear(std::uint32_t first, std::uint32_t last) {
  first_word_ = first / kWordBits;
  words_.assign(last / kWordBits - first_word_ + 1, 0);
}

void CubePart::Subset::add(std::uint32_t vertex) {
  words_[vertex / kWordBits - first_word_] |= bit_of(vertex);
}

bool CubePart::Subset::has(std::uint32_t vertex) const {
  return (words_[vertex / kWordBits - first_word_] & bit_of(vertex)) != 0;
}

std::uint32_t CubePart::Subset::number(std::uint32_t next) {
  before_.resize(words_.size());
  for (std::size_t w = 0; w < words_.size(); ++w) {
    before_[w] = next;
    next += static_cast<std::uint32_t>(std::popcount(words_[w]));
  }
  return next;
}

std::uint32_t CubePart::Subset::number_of(std::uint32_t vertex) const {
  const std::size_t word = vertex / kWordBits - first_word_;
  return before_[word] +
         static_cast<std::uint32_t>(std::popcount(words_[word] & (bit_of(vertex) - 1)));
}

template <class Visit>
void CubePart::Subset::for_each(Visit&& visit) const {
  for (std::size_t w = 0; w < words_.size(); ++w) {
    for (std::uint64_t left = words_[w]; left != 0; left &= left - 1) {
      visit((first_word_ + static_cast<std::uint32_t>(w)) * kWordBits +
            static_cast<std::uint32_t>(std::countr_zero(left)));
    }
  }
}

void CubePart::copy_vertices(const MeshChunk& from, std::size_t n_vertices) {
  const auto copy = [&](const auto& source, auto& to) {
    to.clear();
    if (source.empty()) return;
    to.reserve(3 * n_vertices);
    const auto append = [&](std::uint32_t vertex) {
      const auto first = source.begin() + static_cast<std::ptrdiff_t>(std::size_t{3} * vertex);
      to.insert(to.end(), first, first + 3);
    };
    seam_set_.for_each(append);
    inner_set_.for_each(append);
  };
  copy(from.positions, mesh.positions);
  copy(from.positions_f64, mesh.positions_f64);
  copy(from.normals, mesh.normals);
}

void CubePart::gather(const CubeStore& store, const CubeStore::Cube& cube,
                      std::span<const std::uint8_t> open) {
  const auto [first, last] = std::ranges::minmax(cube.triangles);
  seam_set_.clear(first, last);
  inner_set_.clear(first, last);
  for (const std::uint32_t vertex : cube.triangles) {
    const bool on_seam = store.is_shared(vertex) || (!open.empty() && open[vertex] != 0);
    (on_seam ? seam_set_ : inner_set_).add(vertex);
  }
  const std::uint32_t n_seam = seam_set_.number(0);
  const std::uint32_t n_vertices = inner_set_.number(n_seam);
  seam.clear();
  seam_set_.for_each([&](std::uint32_t vertex) { seam.push_back(vertex); });
  copy_vertices(store.vertices(), n_vertices);
  mesh.index_base = 0;
  mesh.indices.resize(cube.triangles.size());
  std::ranges::transform(cube.triangles, mesh.indices.begin(), [&](std::uint32_t vertex) {
    return (seam_set_.has(vertex) ? seam_set_ : inner_set_).number_of(vertex);
  });
  distances = {};
}

}  // namespace mc::pipe
