// SPDX-License-Identifier: MIT
#include "source/vdb/packed_leaves.hpp"

#if MC_WITH_VDB

#include <utility>

#include "mc/field.hpp"

namespace mc::source {

namespace {

bool is_costly(const VdbStorage& storage) {
  return (storage.compression & (VdbStorage::kZip | VdbStorage::kBlosc)) != 0;
}

}  // namespace

PackedLeaves::PackedLeaves(std::shared_ptr<const MappedFile> file, const TreeKind& kind,
                           std::string what, std::uint64_t cache_bytes)
    : file_(std::move(file)), kind_(kind), what_(std::move(what)) {
  const std::size_t leaf_bytes = LeafReader::kLeafSamples * kind.storage.value_bytes;
  if (is_costly(kind.storage)) cache_.emplace(cache_bytes / leaf_bytes, leaf_bytes);
}

std::unique_ptr<Unpacker> PackedLeaves::take_unpacker() {
  const std::lock_guard lock(mutex_);
  if (unpackers_.empty()) {
    return std::make_unique<Unpacker>(kind_.storage, LeafReader::kLeafSamples, file_->place(),
                                      what_);
  }
  std::unique_ptr<Unpacker> unpacker = std::move(unpackers_.back());
  unpackers_.pop_back();
  return unpacker;
}

template <class T>
void PackedLeaves::read(std::size_t leaf, std::size_t at, T background, T* to) {
  auto* const bytes = reinterpret_cast<std::byte*>(to);
  if (cache_ && cache_->find(leaf, bytes)) return;
  VdbCursor cursor(file_->bytes(), at, file_->place());
  const LeafBuffer stored = take_leaf(cursor, kind_, what_);
  std::unique_ptr<Unpacker> unpacker = take_unpacker();
  unpacker->unpack(stored.values, stored.active, background, to);
  if (cache_) cache_->keep(leaf, bytes);
  const std::lock_guard lock(mutex_);
  unpackers_.push_back(std::move(unpacker));
}

template void PackedLeaves::read(std::size_t, std::size_t, std::uint8_t, std::uint8_t*);
template void PackedLeaves::read(std::size_t, std::size_t, std::int32_t, std::int32_t*);
template void PackedLeaves::read(std::size_t, std::size_t, std::int64_t, std::int64_t*);
template void PackedLeaves::read(std::size_t, std::size_t, float, float*);
template void PackedLeaves::read(std::size_t, std::size_t, double, double*);

}  // namespace mc::source

#endif
