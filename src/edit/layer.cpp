// SPDX-License-Identifier: MIT
#include "edit/layer.hpp"

#include <utility>

#include "base/hash.hpp"

// A block's hash is of its place, samples and active bits; the sum of hashes does not depend on the
// order of blocks.

namespace mc::edit {

namespace {

std::uint64_t hash_of(const Index3& at, const Block& block, std::size_t sample_bytes) {
  std::uint64_t h = IndexHash{}(at);
  for (const std::uint64_t word : block.active) h = base::hash_on(h, word);
  h = base::hash_on(h, {block.samples(), kBlockSamples * sample_bytes});
  return base::hash_on(h, 1);
}

}  // namespace

void Layer::forget_hash(const Block& block) {
  if (block.hashed) sum_ -= block.hash;
}

BlockPtr Layer::exchange(const Index3& at, BlockPtr block) {
  if (summed_) {
    if (block && block->hashed) {
      sum_ += block->hash;
    } else {
      unhashed_.push_back(at);
    }
    if (unhashed_.size() > 2 * blocks_.size() + 1024) summed_ = false;
  }
  if (!block) {
    const auto found = blocks_.find(at);
    if (found == blocks_.end()) return {};
    BlockPtr old = std::move(found->second);
    blocks_.erase(found);
    if (summed_) forget_hash(*old);
    return old;
  }
  BlockPtr& place = blocks_[at];
  std::swap(place, block);
  if (block && summed_) forget_hash(*block);
  return block;
}

void Layer::exchange_all(BlockMap& blocks) {
  std::swap(blocks_, blocks);
  summed_ = false;
}

std::uint64_t Layer::hash() {
  const auto add = [&](const Index3& at, Block& block) {
    if (!block.hashed) {
      block.hash = hash_of(at, block, sample_bytes_);
      block.hashed = true;
    }
    sum_ += block.hash;
  };
  if (!summed_) {
    sum_ = 0;
    for (auto& [at, block] : blocks_) add(at, *block);
    summed_ = true;
  } else {
    for (const Index3& at : unhashed_) {
      const auto found = blocks_.find(at);
      if (found != blocks_.end() && !found->second->hashed) add(at, *found->second);
    }
  }
  unhashed_.clear();
  return sum_;
}

}  // namespace mc::edit
