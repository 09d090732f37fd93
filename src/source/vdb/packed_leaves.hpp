// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "source/mapped_file.hpp"
#include "source/vdb/leaf_cache.hpp"
#include "source/vdb/tree_outline.hpp"

namespace mc::source {

/// Leaves of a tree that stay in their file, each of which is unpacked when it is asked for.
class PackedLeaves {
 public:
  /// Keeps leaves that cost something to unpack, in about `cache_bytes`.
  PackedLeaves(std::shared_ptr<const MappedFile> file, const TreeKind& kind, std::string what,
               std::uint64_t cache_bytes);

  /// Unpacks the leaf that stands at an offset of the file; `leaf` is its number.
  /// Errors   input: damaged.
  /// Threads  may be called from several at once.
  template <class T>
  void read(std::size_t leaf, std::size_t at, T background, T* to);

  [[nodiscard]] std::uint64_t held_bytes() const { return cache_ ? cache_->held_bytes() : 0; }

 private:
  [[nodiscard]] std::unique_ptr<Unpacker> take_unpacker();

  std::shared_ptr<const MappedFile> file_;
  TreeKind kind_;
  std::string what_;
  std::optional<LeafCache> cache_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Unpacker>> unpackers_;  ///< as many as were used at once
};

}  // namespace mc::source
