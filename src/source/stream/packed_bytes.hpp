// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "source/stream/byte_stream.hpp"

namespace mc::source {

/// What an unpacker has read of its stream and not used up.
class PackedBytes {
 public:
  explicit PackedBytes(std::unique_ptr<ByteStream> from)
      : from_(std::move(from)), block_(kBlockBytes) {}

  /// What comes next; empty at the end.
  [[nodiscard]] std::span<std::byte> ahead() {
    if (used_ == filled_ && !ended_) {
      filled_ = from_->read(block_);
      used_ = 0;
      ended_ = filled_ < block_.size();
    }
    return std::span(block_).subspan(used_, filled_ - used_);
  }
  void use(std::size_t n) { used_ += n; }

 private:
  static constexpr std::size_t kBlockBytes = std::size_t{1} << 17U;

  std::unique_ptr<ByteStream> from_;
  std::vector<std::byte> block_;
  std::size_t used_ = 0, filled_ = 0;
  bool ended_ = false;
};

}  // namespace mc::source
