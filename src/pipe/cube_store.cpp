// SPDX-License-Identifier: MIT
#include "pipe/cube_store.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "process/vertex_buffers.hpp"

namespace mc::pipe {

void CubeStore::check_size(std::size_t n_more) const {
  if (n_vertices() + n_more >= std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorKind::limit, {}, "two layers of cubes have 2^32 vertices",
                Remedy::smaller_region);
  }
}

void CubeStore::reserve(std::size_t n_vertices, Precision precision, bool has_normals) {
  if (precision == Precision::f64) {
    vertices_.positions_f64.reserve(3 * n_vertices);
  } else {
    vertices_.positions.reserve(3 * n_vertices);
  }
  if (has_normals) vertices_.normals.reserve(3 * n_vertices);
  users_.reserve(n_vertices);
  next_ids_.reserve(n_vertices);
}

void CubeStore::append(const MeshChunk& chunk) {
  check_size(chunk.n_vertices());
  const auto add = [](const auto& from, auto& to) {
    to.insert(to.end(), from.begin(), from.end());
  };
  add(chunk.positions, vertices_.positions);
  add(chunk.positions_f64, vertices_.positions_f64);
  add(chunk.normals, vertices_.normals);
  users_.resize(users_.size() + chunk.n_vertices(), kUnused);
  next_ids_.resize(users_.size(), kNoId);
}

std::uint32_t CubeStore::append(const MeshChunk& chunk, std::size_t vertex) {
  check_size(1);
  const auto add = [vertex](const auto& from, auto& to) {
    if (from.empty()) return;
    const auto first = from.begin() + static_cast<std::ptrdiff_t>(3 * vertex);
    to.insert(to.end(), first, first + 3);
  };
  add(chunk.positions, vertices_.positions);
  add(chunk.positions_f64, vertices_.positions_f64);
  add(chunk.normals, vertices_.normals);
  users_.push_back(kUnused);
  next_ids_.push_back(kNoId);
  return static_cast<std::uint32_t>(users_.size() - 1);
}

/// Applies change(number) to all numbers of vertices that layers have.
template <class Change>
void CubeStore::change_numbers(Change&& change) {
  for (auto& [z, layer] : layers_) {
    layer.first_vertex = change(layer.first_vertex);
    layer.last_vertex = change(layer.last_vertex);
    for (auto& [at, cube] : layer.cubes) {
      for (std::uint32_t& vertex : cube.triangles) vertex = change(vertex);
    }
  }
}

void CubeStore::drop_first(std::size_t n) {
  if (n == 0) return;
  const auto drop = [n](auto& list, std::size_t each) {
    if (list.empty()) return;
    list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(each * n));
  };
  process::for_vertex_buffers(vertices_, drop);
  drop(users_, 1);
  drop(next_ids_, 1);
  change_numbers([n = static_cast<std::uint32_t>(n)](std::uint32_t vertex) {
    assert(vertex >= n);
    return vertex - n;
  });
}

std::vector<std::uint32_t> CubeStore::keep(std::span<const std::uint8_t> kept) {
  assert(kept.size() == n_vertices());
  std::vector<std::uint32_t> numbers(kept.size());
  std::uint32_t n = 0;
  for (std::size_t v = 0; v < kept.size(); ++v) {
    numbers[v] = n;
    if (kept[v] == 0) continue;
    process::for_vertex_buffers(vertices_, [&](auto& buffer, std::size_t each) {
      if (!buffer.empty()) std::copy_n(&buffer[each * v], each, &buffer[each * n]);
    });
    users_[n] = users_[v];
    next_ids_[n] = next_ids_[v];
    ++n;
  }
  process::for_vertex_buffers(vertices_, [&](auto& buffer, std::size_t each) {
    if (!buffer.empty()) buffer.resize(each * n);
  });
  users_.resize(n);
  next_ids_.resize(n);
  change_numbers([&](std::uint32_t vertex) { return numbers[vertex]; });
  return numbers;
}

/// Makes a cube the latest one.
void CubeStore::find(const Index3& at) {
  latest_layer_ = &layers_[at[2]];
  const auto [found, is_new] = latest_layer_->cubes.try_emplace({at[1], at[0]});
  latest_ = &found->second;
  latest_at_ = at;
  if (!is_new) return;
  latest_->serial = next_serial_++;
  if (expected_ == nullptr) return;
  const auto expected = expected_->find({at[2], at[1], at[0]});
  assert(expected != expected_->end());
  latest_->triangles.reserve(3 * static_cast<std::size_t>(expected->second));
}

void CubeStore::add(const Index3& at, const Triangle& triangle, double n_extracted) {
  if (latest_ == nullptr || latest_at_ != at) find(at);
  Layer& layer = *latest_layer_;
  Cube& cube = *latest_;
  cube.n_extracted += n_extracted;
  for (const std::uint32_t vertex : triangle) {
    cube.triangles.push_back(vertex);
    layer.first_vertex = std::min(layer.first_vertex, vertex);
    layer.last_vertex = std::max(layer.last_vertex, vertex);
    std::uint32_t& user = users_[vertex];
    if (user == cube.serial) continue;
    user = user == kUnused ? cube.serial : kShared;
    ++cube.n_uses;
  }
}

CubeStore::Layer CubeStore::take_lowest() {
  latest_ = nullptr;
  return std::move(layers_.extract(layers_.begin()).mapped());
}

Vec3 CubeStore::centroid(const Triangle& triangle) const {
  const auto of = [&](const auto& p) {
    const auto [a, b, c] = triangle;
    Vec3 out;
    for (std::size_t n = 0; n < 3; ++n) {
      out[n] = (double{p[std::size_t{3} * a + n]} + p[std::size_t{3} * b + n] +
                p[std::size_t{3} * c + n]) /
               3;
    }
    return out;
  };
  return vertices_.positions_f64.empty() ? of(vertices_.positions) : of(vertices_.positions_f64);
}

void CubeStore::mark_used(std::vector<std::uint8_t>& used) const {
  used.assign(n_vertices(), 0);
  for (const auto& [z, layer] : layers_) {
    for (const auto& [at, cube] : layer.cubes) {
      for (const std::uint32_t vertex : cube.triangles) used[vertex] = 1;
    }
  }
}

}  // namespace mc::pipe
