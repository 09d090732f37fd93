// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "extract/components/run_table.hpp"
#include "field/block.hpp"

// Which components of a volume remain. The others are left out before a vertex is numbered: their
// samples count as not solid. The mesh is then that of the components which remain, bit for bit,
// since the vertices and triangles of a component depend on no sample of another one. Samples
// themselves do not change, nor do normals.

namespace mc::extraction {

/// Of a dense volume: a bit for each solid run.
class DenseSelection {
 public:
  /// `plane_starts` are the first runs of the planes from `first_plane` on, an index along k.
  DenseSelection(std::int32_t first_plane, std::vector<std::uint64_t> plane_starts, RunBits kept,
                 Inside inside)
      : first_plane_(first_plane),
        plane_starts_(std::move(plane_starts)),
        kept_(std::move(kept)),
        inside_(inside) {}

  /// Makes dropped components of plane k not solid. `plane` are all rows of the plane, `words` the
  /// same to write.
  void apply(std::int32_t k, const BitPlane& plane, std::uint64_t* words) const {
    const std::int64_t at = std::int64_t{k} - first_plane_;
    if (at < 0 || at >= static_cast<std::int64_t>(plane_starts_.size())) return;  // constant layer
    std::uint64_t run = plane_starts_[static_cast<std::size_t>(at)];
    for (std::size_t j = 0; j < plane.n_rows; ++j) {
      std::uint64_t* row = words + j * plane.words_per_row;
      for_each_run(plane, j, inside_, [&](std::int32_t first, std::int32_t last) {
        if (!kept_[run++]) flip(row, first, last);
      });
    }
  }

  [[nodiscard]] std::uint64_t bytes() const {
    return kept_.bytes() + plane_starts_.size() * sizeof(std::uint64_t);
  }

 private:
  /// Bits [first, last] of a row. for_each_run() has read the words of a run before it names it,
  /// except the last one, whose bits past `last` stay as they are.
  static void flip(std::uint64_t* row, std::int32_t first, std::int32_t last) {
    const auto from = static_cast<std::uint64_t>(first), to = static_cast<std::uint64_t>(last);
    for (std::uint64_t w = from / 64; w <= to / 64; ++w) {
      const std::uint64_t low =
          w == from / 64 ? ~std::uint64_t{0} << (from % 64) : ~std::uint64_t{0};
      const std::uint64_t high =
          w == to / 64 ? ~std::uint64_t{0} >> (63 - to % 64) : ~std::uint64_t{0};
      row[w] ^= low & high;
    }
  }

  std::int32_t first_plane_;
  std::vector<std::uint64_t> plane_starts_;
  RunBits kept_;
  Inside inside_;
};

/// Of a sparse volume: the samples and blocks that are left out.
class SparseSelection {
 public:
  /// Samples of a block of samples, or blocks of a node.
  struct Dropped {
    Index3 at;
    field::Mask512 mask;
  };
  /// A cube of nodes.
  struct DroppedTile {
    Index3 origin;
    std::int32_t size;
  };

  /// Each list is ordered by (z, y, x); `blocks` have both kinds of samples, those of `nodes` and
  /// `tiles` are solid throughout.
  SparseSelection(std::vector<Dropped> blocks, std::vector<Dropped> nodes,
                  std::vector<DroppedTile> tiles)
      : blocks_(std::move(blocks)), nodes_(std::move(nodes)), tiles_(std::move(tiles)) {}

  /// The samples of a block that are left out, or null.
  [[nodiscard]] const field::Mask512* samples(const Index3& block) const {
    return find(blocks_, block);
  }
  /// Whether a block that is solid throughout is left out. In part of it that is enough: the rest
  /// lies outside the region.
  [[nodiscard]] bool drops(const Index3& block) const {
    if (samples(block) != nullptr) return true;
    const Index3 node = field::block_of(block);
    if (const field::Mask512* mask = find(nodes_, node); mask != nullptr) {
      return field::test(*mask, field::bit_index(block));
    }
    return std::ranges::any_of(tiles_, [&](const DroppedTile& tile) {
      const auto within = [&](std::size_t a) {
        return node[a] >= tile.origin[a] && node[a] < tile.origin[a] + tile.size;
      };
      return within(0) && within(1) && within(2);
    });
  }

  [[nodiscard]] std::uint64_t bytes() const {
    return (blocks_.size() + nodes_.size()) * sizeof(Dropped) + tiles_.size() * sizeof(DroppedTile);
  }

 private:
  static const field::Mask512* find(const std::vector<Dropped>& list, const Index3& at) {
    const auto found = std::lower_bound(
        list.begin(), list.end(), at,
        [](const Dropped& a, const Index3& b) { return field::comes_before(a.at, b); });
    return found != list.end() && field::same(found->at, at) ? &found->mask : nullptr;
  }

  std::vector<Dropped> blocks_, nodes_;
  std::vector<DroppedTile> tiles_;
};

}  // namespace mc::extraction

namespace mc {

/// Which components of a volume's isosurface remain: ExtractOptions::selection.
class ComponentSelection {
 public:
  explicit ComponentSelection(extraction::DenseSelection dense) : of_(std::move(dense)) {}
  explicit ComponentSelection(extraction::SparseSelection sparse) : of_(std::move(sparse)) {}

  [[nodiscard]] const extraction::DenseSelection& dense() const {
    return std::get<extraction::DenseSelection>(of_);
  }
  [[nodiscard]] const extraction::SparseSelection& sparse() const {
    return std::get<extraction::SparseSelection>(of_);
  }
  [[nodiscard]] std::uint64_t bytes() const {
    return std::visit([](const auto& selection) { return selection.bytes(); }, of_);
  }

 private:
  std::variant<extraction::DenseSelection, extraction::SparseSelection> of_;
};

}  // namespace mc
