// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "edit/block.hpp"

namespace mc::edit {

/// The blocks that edits made of one kind of samples, and a hash of them all that follows each
/// change at the change's cost.
class Layer {
 public:
  explicit Layer(std::size_t sample_bytes) : pool_(sample_bytes), sample_bytes_(sample_bytes) {}

  [[nodiscard]] const Block* find(const Index3& at) const {
    const auto found = blocks_.find(at);
    return found == blocks_.end() ? nullptr : found->second.get();
  }
  /// Puts a block there, or none, and hands out what was there.
  BlockPtr exchange(const Index3& at, BlockPtr block);
  /// The same for all blocks.
  void exchange_all(BlockMap& blocks);

  [[nodiscard]] const BlockMap& blocks() const { return blocks_; }
  [[nodiscard]] BlockPool& pool() { return pool_; }
  [[nodiscard]] const BlockPool& pool() const { return pool_; }
  [[nodiscard]] std::size_t sample_bytes() const { return sample_bytes_; }
  /// The sum of the blocks' hashes. Cost   blocks that changed since the last call.
  [[nodiscard]] std::uint64_t hash();

 private:
  void forget_hash(const Block& block);

  BlockMap blocks_;
  BlockPool pool_;
  std::size_t sample_bytes_;
  bool summed_ = false;  // whether sum_ is that of all blocks but those of unhashed_
  std::uint64_t sum_ = 0;
  std::vector<Index3> unhashed_;
};

}  // namespace mc::edit
