// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <unordered_map>
#include <utility>
#include <vector>

#include "field/block.hpp"
#include "mc/field.hpp"

// Blocks of 8x8x8 samples, x fastest, in the volume's type and native byte order: what a store
// keeps of a volume that was touched.

namespace mc::edit {

using field::block_of;
using field::blocks_of;
using field::comes_before;
using field::IndexHash;
using field::kBlockSamples;
using field::kBlockSize;
using field::Mask512;
using field::n_ones;
using field::origin_of;
using field::samples_of;

/// Its samples follow it in memory.
struct alignas(64) Block {
  Mask512 active{};        ///< sparse volumes
  std::uint64_t step = 0;  ///< of the history, that made it
  std::uint64_t hash = 0;
  bool hashed = false;

  [[nodiscard]] std::byte* samples() { return reinterpret_cast<std::byte*>(this + 1); }
  [[nodiscard]] const std::byte* samples() const {
    return reinterpret_cast<const std::byte*>(this + 1);
  }
};

struct BlockDelete {
  void operator()(Block* block) const noexcept {
    ::operator delete (static_cast<void*>(block), std::align_val_t{alignof(Block)});
  }
};
using BlockPtr = std::unique_ptr<Block, BlockDelete>;

/// Blocks of one sample size; those given back are handed out again.
class BlockPool {
 public:
  explicit BlockPool(std::size_t sample_bytes)
      : block_bytes_(sizeof(Block) + kBlockSamples * sample_bytes) {}

  /// Anything may be in its samples.
  [[nodiscard]] BlockPtr take() {
    ++n_live_;
    if (free_.empty()) {
      const std::align_val_t line{alignof(Block)};
      return BlockPtr(::new (::operator new(block_bytes_, line)) Block);
    }
    BlockPtr block = std::move(free_.back());
    free_.pop_back();
    *block = Block{};
    return block;
  }
  void give_back(BlockPtr block) {
    if (!block) return;
    --n_live_;
    if (free_.size() < kMostFree) free_.push_back(std::move(block));
  }
  [[nodiscard]] std::size_t block_bytes() const { return block_bytes_; }
  [[nodiscard]] std::uint64_t live_bytes() const { return n_live_ * block_bytes_; }

 private:
  static constexpr std::size_t kMostFree = 4096;

  std::size_t block_bytes_;
  std::uint64_t n_live_ = 0;
  std::vector<BlockPtr> free_;
};

/// The least box around the set samples of a block; empty where there are none.
[[nodiscard]] inline IndexBox box_of(const Index3& block, const Mask512& mask) {
  std::uint64_t plane = 0;
  std::uint64_t planes = 0;
  for (std::size_t k = 0; k < mask.size(); ++k) {
    plane |= mask[k];
    planes |= std::uint64_t{mask[k] != 0} << k;
  }
  if (plane == 0) return {};
  std::uint64_t columns = plane | plane >> 32U;
  columns |= columns >> 16U;
  columns = (columns | columns >> 8U) & 0xFFU;
  const auto lowest = [](std::uint64_t bits) { return std::countr_zero(bits); };
  const auto highest = [](std::uint64_t bits) { return 63 - std::countl_zero(bits); };
  const Index3 at = origin_of(block);
  return {{at[0] + lowest(columns), at[1] + lowest(plane) / kBlockSize, at[2] + lowest(planes)},
          {at[0] + highest(columns), at[1] + highest(plane) / kBlockSize, at[2] + highest(planes)}};
}

/// Calls f with each block that a box of samples meets, by (z, y, x).
template <class F>
void for_blocks_of(const IndexBox& box, F&& f) {
  const IndexBox blocks = blocks_of(box);
  for (std::int32_t bk = blocks.lo[2]; bk <= blocks.hi[2]; ++bk) {
    for (std::int32_t bj = blocks.lo[1]; bj <= blocks.hi[1]; ++bj) {
      for (std::int32_t bi = blocks.lo[0]; bi <= blocks.hi[0]; ++bi) f(Index3{bi, bj, bk});
    }
  }
}

/// Copies n_rows of kRowBytes, or of row_bytes where that is 0: a size that the compiler knows is a
/// move or two.
template <std::size_t kRowBytes>
void copy_rows(const std::byte* from, std::size_t from_stride, std::byte* to, std::size_t to_stride,
               std::size_t row_bytes, std::size_t n_rows) {
  for (std::size_t row = 0; row < n_rows; ++row, from += from_stride, to += to_stride) {
    std::memcpy(to, from, kRowBytes != 0 ? kRowBytes : row_bytes);
  }
}

/// Copies what a block and a box have in common into the box's samples, x fastest.
inline void copy_from_block(const Index3& block, const std::byte* samples, std::size_t sample_bytes,
                            const IndexBox& box, std::byte* out) {
  const IndexBox part = common_part(samples_of(block), box);
  const Index3 from = origin_of(block);
  const auto size = [](std::int64_t v) { return static_cast<std::size_t>(v); };
  const std::size_t row_bytes = size(part.extent(0)) * sample_bytes;
  const std::size_t block_row = kBlockSize * sample_bytes;
  const std::size_t box_row = size(box.extent(0)) * sample_bytes;
  const auto copy = row_bytes == 32  ? &copy_rows<32>
                    : row_bytes == 8 ? &copy_rows<8>
                                     : &copy_rows<0>;
  for (std::int32_t k = part.lo[2]; k <= part.hi[2]; ++k) {
    const std::size_t in = size(k - from[2]) * kBlockSize + size(part.lo[1] - from[1]);
    const std::size_t to = size(k - box.lo[2]) * size(box.extent(1)) + size(part.lo[1] - box.lo[1]);
    copy(samples + in * block_row + size(part.lo[0] - from[0]) * sample_bytes, block_row,
         out + to * box_row + size(part.lo[0] - box.lo[0]) * sample_bytes, box_row, row_bytes,
         size(part.extent(1)));
  }
}

using BlockMap = std::unordered_map<Index3, BlockPtr, IndexHash>;

}  // namespace mc::edit
