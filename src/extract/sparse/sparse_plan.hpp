// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "extract/components/selection.hpp"
#include "extract/sparse/block_index.hpp"
#include "extract/sparse/block_kernels.hpp"
#include "extract/sparse/block_walk.hpp"
#include "mc/extract.hpp"
#include "mc/field.hpp"

// What is known of a sparse volume before its surface is made: the blocks that hold the surface,
// their sample bits, and how many vertices each has, so that any block's ids are known.

namespace mc::extraction {

/// Indices that leave room for neighbours in 32 bits.
inline constexpr std::int32_t kReach = (1 << 30) - 1;
/// Where samples of a sparse volume can be.
inline constexpr IndexBox kAllSamples{{-kReach, -kReach, -kReach}, {kReach, kReach, kReach}};

/// The sample bits of leaves that have both kinds, in groups, so that threads fill them side by
/// side and nothing is copied to grow.
class BitPool {
 public:
  static constexpr std::size_t kGroup = 1024;

  void resize(std::size_t n_groups) { groups_.resize(n_groups); }
  [[nodiscard]] std::vector<Mask512>& group(std::size_t n) { return groups_[n]; }
  [[nodiscard]] Mask512& at(std::uint32_t place) { return groups_[place / kGroup][place % kGroup]; }
  [[nodiscard]] std::size_t n_groups() const { return groups_.size(); }
  [[nodiscard]] const Mask512& operator[](std::uint32_t place) const {
    assert(place / kGroup < groups_.size() && place % kGroup < groups_[place / kGroup].size());
    return groups_[place / kGroup][place % kGroup];
  }
  [[nodiscard]] static std::uint32_t place(std::size_t group, std::size_t n) {
    return static_cast<std::uint32_t>(group * kGroup + n);
  }
  [[nodiscard]] std::uint64_t bytes() const {
    std::uint64_t n = 0;
    for (const std::vector<Mask512>& group : groups_) n += group.size();
    return n * sizeof(Mask512) + groups_.size() * sizeof(std::vector<Mask512>);
  }

 private:
  std::vector<std::vector<Mask512>> groups_;
};

/// Ones for the samples that there are, of a block at a region's border and its upper neighbours.
struct BlockSamples {
  std::array<Mask512, 8> masks;
  BlockBits bits;
};

/// The layers of blocks that may hold some of the surface, by the blocks' index along k. Cost: a
/// look at all tiles.
LayerRange block_layers(const LeafReader& reader, const ExtractOptions& options);

/// What all runs of one extraction share. Constant once built.
///
/// Of a part, only leaves are read whose samples its bits depend on: those of its own layers of
/// blocks and of the two above. The vertices of the next layer are counted like its own, so that
/// indices continue there; what lies further up is only known as far as the layers below need it.
class SparsePlan {
 public:
  /// Errors: limit, where the volume reaches past the indices that fit.
  /// Cost: one read of all leaves; 64 bytes a leaf that the surface passes through, 21 a block that
  /// holds some of it.
  SparsePlan(const LeafReader& reader, const ExtractOptions& options);

  [[nodiscard]] std::uint64_t bytes() const;
  /// All blocks that are known: first the part's own, then those above.
  [[nodiscard]] std::span<const SurfaceBlock> blocks() const { return blocks_; }
  /// Blocks to be made, which come first.
  [[nodiscard]] std::size_t n_own() const { return n_own_; }
  /// The id of the first vertex of block n, or the number of all.
  [[nodiscard]] std::uint64_t first_vertex(std::size_t n) const;

  /// Bits of the block at (x, y, z) from the walk's and of its upper neighbours. It must be listed.
  template <std::size_t kWidth>
  [[nodiscard]] BlockBits bits_around(const BlockWalk<kWidth>& walk, std::size_t x, std::size_t y,
                                      std::size_t z) const {
    assert(walk.at(x, y, z) < blocks_.size());
    const SurfaceBlock& block = blocks_[walk.at(x, y, z)];
    BlockBits out;
    for (std::size_t n = 0; n < 8; ++n) {
      const std::size_t at = walk.at(x + (n & 1U), y + (n >> 1 & 1U), z + (n >> 2));
      const bool above = (block.above >> n & 1U) != 0;
      out[n] = at != kNoBlock ? bits_of(blocks_[at]) : above ? &kAllAbove : &kAllBelow;
    }
    return out;
  }
  /// Fills `out` and returns its bits where samples of the block's cells may not exist, else null.
  const BlockBits* samples_around(const Index3& block, BlockSamples& out) const;

  /// Sample bits of a block that the surface passes through; null if it has one kind only.
  [[nodiscard]] const Mask512* mixed_bits(const SurfaceBlock& block) const {
    const bool uniform = block.bits == SurfaceBlock::kBelow || block.bits == SurfaceBlock::kAbove;
    return uniform ? nullptr : &pool_[block.bits];
  }

  [[nodiscard]] const BlockIndex& index() const { return index_; }
  [[nodiscard]] const LeafReader& reader() const { return reader_; }
  [[nodiscard]] const ExtractOptions& options() const { return options_; }
  [[nodiscard]] const Threshold& threshold() const { return threshold_; }
  /// The region, or all indices there are.
  [[nodiscard]] const IndexBox& box() const { return box_; }
  /// Whether a region's border is closed.
  [[nodiscard]] bool capped() const { return capped_; }

 private:
  static const Mask512 kAllBelow, kAllAbove;
  static constexpr std::size_t kStride = 16;  // blocks to a known id

  /// Whether bits of a block of this layer are needed.
  [[nodiscard]] bool reaches(std::int32_t layer) const {
    return layers_.first <= layer && layer - 2 < layers_.last;
  }
  std::vector<LeafSide> classify_leaves();
  LeafSide classify_leaf(std::size_t n, const std::byte* values, Mask512& bits) const;
  void find_blocks(const std::vector<LeafSide>& sides);
  void check_reach() const;
  void find_capped_blocks(const std::vector<LeafSide>& sides);
  [[nodiscard]] std::vector<Index3> region_faces() const;
  void leave_out(const SparseSelection& selection);
  void count_vertices();
  [[nodiscard]] Mask512 inside_region(const Index3& block, std::int32_t margin) const;
  [[nodiscard]] bool touches_region(const Index3& block, std::int32_t margin) const;
  [[nodiscard]] const Mask512* bits_of(const SurfaceBlock& block) const {
    return block.bits == SurfaceBlock::kBelow   ? &kAllBelow
           : block.bits == SurfaceBlock::kAbove ? &kAllAbove
                                                : &pool_[block.bits];
  }

  const LeafReader& reader_;
  ExtractOptions options_;
  Threshold threshold_;
  IndexBox box_;
  bool capped_;
  bool above_outside_;
  LayerRange layers_;  ///< the part's, or all
  BlockIndex index_;
  BitPool pool_;
  std::vector<SurfaceBlock> blocks_;
  std::size_t n_own_ = 0;
  std::vector<std::uint64_t> first_;  ///< id of the first vertex of every kStride-th block
};

}  // namespace mc::extraction
