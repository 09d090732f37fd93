// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "pipe/cube_store.hpp"

namespace mc::pipe {

/// Takes the chunks of a mesh in order. Lists the triangles in order, each as soon as it and those
/// before it have all their vertices, which may lie in later chunks.
class TriangleFeed {
 public:
  /// Appends the chunk's vertices to the store. Returns the triangles that are complete now, by the
  /// numbers of their vertices there; valid until the next call.
  /// `is_forward`: its triangles and all later ones name vertices from its first one on.
  std::span<const CubeStore::Triangle> add(const MeshChunk& chunk, bool is_forward,
                                           CubeStore& store) {
    if (is_forward) first_named_ = chunk.index_base;
    store.append(chunk);
    const auto id_of = [&](std::size_t n) { return chunk.index_base + chunk.indices[n]; };
    complete_.clear();
    take_waiting(store.n_vertices());
    for (std::size_t n = 0; n < chunk.indices.size(); n += 3) {
      const Ids ids{id_of(n), id_of(n + 1), id_of(n + 2)};
      if (waiting_.empty() && is_complete(ids, store.n_vertices())) {
        complete_.push_back(numbers(ids));
      } else {
        least_waiting_ = std::min(least_waiting_, std::ranges::min(ids));
        waiting_.push_back(ids);
      }
    }
    return complete_;
  }
  /// No later triangle names a vertex of the store before this one.
  [[nodiscard]] std::uint64_t least_named() const {
    return std::min(first_named_, least_waiting_) - first_id_;
  }
  /// The store has dropped its first vertices.
  void dropped(std::size_t n) { first_id_ += n; }

 private:
  using Ids = std::array<std::uint64_t, 3>;
  static constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();

  [[nodiscard]] bool is_complete(const Ids& ids, std::size_t n_vertices) const {
    return std::ranges::max(ids) - first_id_ < n_vertices;
  }
  [[nodiscard]] CubeStore::Triangle numbers(const Ids& ids) const {
    const auto number = [&](std::uint64_t id) {
      return static_cast<std::uint32_t>(id - first_id_);
    };
    return {number(ids[0]), number(ids[1]), number(ids[2])};
  }
  void take_waiting(std::size_t n_vertices) {
    std::size_t n = 0;
    while (n < waiting_.size() && is_complete(waiting_[n], n_vertices)) {
      complete_.push_back(numbers(waiting_[n++]));
    }
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(n));
    if (waiting_.empty()) least_waiting_ = kNone;
  }

  std::vector<CubeStore::Triangle> complete_;
  std::vector<Ids> waiting_;
  std::uint64_t first_id_ = 0;           ///< of the store's first vertex
  std::uint64_t first_named_ = 0;        ///< least id that later triangles name
  std::uint64_t least_waiting_ = kNone;  ///< least id since waiting_ was empty
};

}  // namespace mc::pipe
